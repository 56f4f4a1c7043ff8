// The step: shape functions, uniform and linear fields, waves, order of convergence.
#include "tests/catch.hpp"
#include "tests/mpm/blocks.hpp"

using namespace mpm;
using namespace mpm::test;

namespace {

/// From the first to the second time at which the projection of the velocities on their first field changes its sign.
double half_period(Solver<2>& solver) {
  std::vector<Vec<2>> field;
  for (const auto& point : solver.points) field.push_back(point.velocity);
  const auto projection = [&] {
    double sum = 0;
    for (std::size_t k = 0; k < field.size(); ++k) sum += field[k].dot(solver.points[k].velocity);
    return sum;
  };
  double before = projection(), time = 0;
  std::vector<double> turns;
  while (turns.size() < 2) {
    const double dt = solver.stable_step();
    solver.step(dt);
    const double now = projection();
    if (now * before <= 0) turns.push_back(time + dt * before / (before - now));
    before = now;
    time += dt;
  }
  return turns[1] - turns[0];
}

}  // namespace

TEST_CASE("shape functions add up to one and carry linear fields") {
  for (const Shape shape : {Shape::bspline, Shape::gimp, Shape::linear}) {
    for (double xi = -2.3; xi < 2.4; xi += 0.0371) {
      double weight[3], slope[3];
      const double cell = 0.4;
      const int first = shape_along_axis(shape, xi, 1 / cell, 0.25, weight, slope);
      double sum = 0, place = 0, slopes = 0, unit = 0;
      for (int k = 0; k < 3; ++k) {
        CHECK(weight[k] >= 0);
        sum += weight[k];
        place += weight[k] * (first + k);
        slopes += slope[k];
        unit += slope[k] * (first + k) * cell;
      }
      CHECK(sum == Approx(1).epsilon(1e-14));
      CHECK(place == Approx(xi).margin(1e-13));
      CHECK(slopes == Approx(0).margin(1e-12));
      CHECK(unit == Approx(1).epsilon(1e-12));
    }
  }
}

TEST_CASE("a uniform strain passes the patch test with every shape function, in the plane and in space") {
  for (const Shape shape : {Shape::bspline, Shape::gimp, Shape::linear}) {
    for (const Scheme scheme : {Scheme::usf, Scheme::musl}) {
      CAPTURE(int(shape), int(scheme));
      // An oedometer in slow motion: the plate goes down, the strain is the same everywhere.
      const std::array<int, 2> cells{3, 4};
      auto solver = block<2>(cells, 0.25, soil, 2000);
      solver->options.shape = shape;
      solver->options.scheme = scheme;
      enclose<2>(*solver, cells);
      solver->follow_axis = 1;
      solver->followed = 3;
      auto& plate = solver->planes.all[3];
      plate.velocity.times = {0};
      plate.velocity.velocities = {Vec<2>(0, -0.01)};
      set_velocity<2>(*solver, [](const Vec<2>& x) { return Vec<2>(0, -0.01 * x[1]); });
      for (int k = 0; k < 40; ++k) solver->step(1e-3);
      double low = 1e300, high = -1e300;
      for (const auto& point : solver->points) {
        low = std::min(low, point.stress(1, 1));
        high = std::max(high, point.stress(1, 1));
        CHECK(std::abs(point.stress(0, 1)) < 1e-9 * soil.young);
        CHECK(point.stress(0, 0) / point.stress(1, 1) == Approx(1.0 / 3).epsilon(1e-6));  // nu/(1 - nu)
      }
      CHECK(high - low < 2e-4 * std::abs(low));
      CHECK(low == Approx(soil.wave() * std::log(1 - 0.01 * solver->time)).epsilon(2e-3));
    }
  }
  const std::array<int, 3> cells{2, 2, 2};
  auto solver = block<3>(cells, 0.5, soil, 2000);
  enclose<3>(*solver, cells);
  set_velocity<3>(*solver, [](const Vec<3>&) { return Vec<3>(Vec<3>::Zero()); });
  for (auto& point : solver->points) point.stress = -1e4 * Mat<3>::Identity();
  for (int k = 0; k < 20; ++k) solver->step(1e-3);
  for (const auto& point : solver->points) {
    CHECK((point.position - point.first).norm() < 1e-14);
    CHECK((point.stress + 1e4 * Mat<3>::Identity()).norm() < 1e-6);
  }
}

TEST_CASE("pressure on free surfaces is in equilibrium with the same stress inside, and moves with the surface") {
  auto solver = block<2>({4, 3}, 0.1, soil, 2000);
  solver->options.surface_pressure = 5e4;
  for (auto& point : solver->points) {
    point.position += Vec<2>(0.037, -0.021);  // not in step with the grid
    point.stress = -5e4 * Mat<2>::Identity();
  }
  const auto start = solver->points;
  for (int k = 0; k < 50; ++k) solver->step(solver->stable_step());
  for (std::size_t k = 0; k < start.size(); ++k) {
    CHECK((solver->points[k].position - start[k].position).norm() < 1e-14);
  }
  // Twice the pressure, statically: the block shrinks until its stress carries it.
  solver->options.surface_pressure = 1e5;
  solver->options.pic_fraction = 1;
  for (int k = 0; k < 3000; ++k) solver->step(solver->stable_step());
  double p = 0, volume = 0;
  for (const auto& point : solver->points) {
    p += mean_pressure<2>(point.stress) * point.volume;
    volume += point.volume;
  }
  CHECK(p / volume == Approx(1e5).epsilon(1e-3));
}

TEST_CASE("standing waves of compression and of shear have the elastic speeds within 1 %") {
  for (const Shape shape : {Shape::bspline, Shape::gimp}) {
    for (const bool shear : {false, true}) {
      CAPTURE(int(shape), shear);
      const std::array<int, 2> cells{28, 28};
      auto solver = block<2>(cells, 1.0 / 28, soil, 2000);
      solver->options.shape = shape;
      solver->options.pic_fraction = 0;
      solver->options.cfl = 0.2;
      enclose<2>(*solver, cells);
      const double a = 1e-4;
      set_velocity<2>(*solver, [&](const Vec<2>& x) {
        const double s = std::sin(pi * x[0]) * std::cos(pi * x[1]), c = std::cos(pi * x[0]) * std::sin(pi * x[1]);
        return Vec<2>(a * s, shear ? -a * c : a * c);
      });
      const double speed = std::sqrt((shear ? soil.shear() : soil.wave()) / 2000);
      // The field's wave number is sqrt(2) pi.
      CHECK(half_period(*solver) == Approx(pi / (std::sqrt(2.0) * pi * speed)).epsilon(0.01));
    }
  }
}

TEST_CASE("errors against a manufactured solution fall with the square of the cell") {
  // u = A sin(pi x) cos(pi y) ... sin(w t), a gradient field, held up by the body force that it needs.
  const double A = 1e-5, w = 60, density = 2000, end = 0.02, c2 = soil.wave() / density;
  std::vector<double> errors;
  for (const int n : {6, 12, 24}) {
    const std::array<int, 2> cells{n, n};
    auto solver = block<2>(cells, 1.0 / n, soil, density);
    solver->options.pic_fraction = 0;
    enclose<2>(*solver, cells);
    const auto field = [](const Vec<2>& x) {
      return Vec<2>(std::sin(pi * x[0]) * std::cos(pi * x[1]), std::cos(pi * x[0]) * std::sin(pi * x[1]));
    };
    solver->body_force = [&](const Vec<2>& x, double t) {
      return Vec<2>(A * (2 * pi * pi * c2 - w * w) * std::sin(w * t) * field(x));
    };
    set_velocity<2>(*solver, [&](const Vec<2>& x) { return Vec<2>(A * w * field(x)); });
    const double dt = 4e-5 * 16 * 16 / (n * n);  // the scheme is of first order in time
    const long steps = std::lround(end / dt);
    for (long k = 0; k < steps; ++k) solver->step(dt);
    double sum = 0;
    for (const auto& point : solver->points) {
      sum += (point.position - point.first - A * std::sin(w * solver->time) * field(point.first)).squaredNorm();
    }
    errors.push_back(std::sqrt(sum / double(solver->points.size())) / A);
  }
  CAPTURE(errors);
  CHECK(errors[2] < 0.02);
  CHECK(std::log2(errors[0] / errors[1]) > 1.7);
  CHECK(std::log2(errors[1] / errors[2]) > 1.7);
}
