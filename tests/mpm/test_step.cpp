#include "tests/catch.hpp"
#include "tests/mpm/blocks.hpp"

using namespace mpm;
using namespace mpm::test;

namespace {

const ElasticModuli soil{1e7, 0.25};

template <int D>
Vec<D> momentum_of(const Solver<D>& solver) {
  Vec<D> sum = Vec<D>::Zero();
  for (const auto& point : solver.points) sum += point.mass * point.velocity;
  return sum;
}

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

TEST_CASE("the finite map of a spin is a rotation, that of a stretch its exponential") {
  Mat<3> spin;
  spin << 0, -0.3, 0.2, 0.3, 0, -0.1, -0.2, 0.1, 0;
  const Mat<3> turn = Mat<3>::Identity() + finite_increment<3>(spin);
  CHECK((turn * turn.transpose() - Mat<3>::Identity()).norm() < 1e-13);
  CHECK(turn.determinant() == Approx(1).epsilon(1e-14));
  Mat<2> stretch = Mat<2>::Zero();
  stretch(0, 0) = 0.4;
  stretch(1, 1) = -2e-4;
  const Mat<2> map = finite_increment<2>(stretch);
  CHECK(map(0, 0) == Approx(std::expm1(0.4)).epsilon(1e-13));
  CHECK(map(1, 1) == Approx(std::expm1(-2e-4)).epsilon(1e-12));
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

TEST_CASE("momentum of a free body is kept to round-off, and grows with gravity") {
  for (const Scheme scheme : {Scheme::usf, Scheme::musl}) {
    for (const bool affine : {true, false}) {
      auto solver = block<2>({5, 4}, 0.1, soil, 2000);
      solver->options.scheme = scheme;
      solver->options.affine = affine;
      set_velocity<2>(*solver, [](const Vec<2>& x) {
        return Vec<2>(2 + 3 * std::sin(9 * x[1]), -1 + 2 * std::cos(7 * x[0]) - 4 * x[0]);
      });
      double scale = 0;
      for (const auto& point : solver->points) scale += point.mass * point.velocity.norm();
      const Vec<2> before = momentum_of(*solver);
      for (int k = 0; k < 200; ++k) solver->step(solver->stable_step());
      CHECK((momentum_of(*solver) - before).norm() < 1e-13 * scale);
      solver->options.gravity = Vec<2>(0.3, -9.81);
      const double since = solver->time;
      const Vec<2> then = momentum_of(*solver);
      for (int k = 0; k < 50; ++k) solver->step(solver->stable_step());
      double mass = 0;
      for (const auto& point : solver->points) mass += point.mass;
      const Vec<2> gained = mass * (solver->time - since) * solver->options.gravity;
      CHECK((momentum_of(*solver) - then - gained).norm() < 1e-12 * scale);
    }
  }
}

TEST_CASE("what planes and bodies push the soil with is what its momentum changes by") {
  const std::array<int, 2> cells{6, 6};
  auto solver = block<2>(cells, 0.1, soil, 2000);
  solver->options.gravity = Vec<2>(0, -9.81);
  solver->planes.all.push_back(roller<2>(0, 0, true));
  solver->planes.all.push_back(roller<2>(1, 0, true));
  solver->planes.all[1].fixed = true;
  Body<2> pipe;
  pipe.kind = BodyKind::disc;
  pipe.centre = Vec<2>(0.45, 0.75);
  pipe.radius = 0.2;
  pipe.velocity.times = {0};
  pipe.velocity.velocities = {Vec<2>(-0.2, -1)};
  solver->bodies.all.push_back(pipe);
  double mass = 0;
  for (const auto& point : solver->points) mass += point.mass;
  for (int k = 0; k < 200; ++k) solver->step(solver->stable_step());
  Vec<2> impulse = mass * solver->time * solver->options.gravity;
  for (const auto& plane : solver->planes.all) impulse += plane.reaction.impulse;
  for (const auto& body : solver->bodies.all) impulse += body.reaction.impulse;
  CHECK((momentum_of(*solver) - impulse).norm() < 1e-10 * mass);
  CHECK(solver->bodies.all[0].reaction.impulse[1] < -0.1);  // the pipe did press
}

TEST_CASE("a plane of symmetry halves a footing's force to round-off, and nothing is counted by plane and body both") {
  // A rough box on a block, whole and its right half; and the half with a disc instead.
  struct Forces {
    Vec<2> body, base, symmetry, missing;
    double work;
  };
  const auto press = [](bool half, BodyKind kind, bool fixed) {
    auto solver = block<2>({half ? 5 : 10, 5}, 0.1, soil, 2000);
    if (!half) {
      for (auto& point : solver->points) point.position[0] -= 0.5;
    }
    solver->options.gravity = Vec<2>(0, -9.81);
    solver->planes.all.push_back(roller<2>(1, 0, true));
    solver->planes.all[0].fixed = true;
    if (half) {
      solver->planes.all.push_back(roller<2>(0, 0, true));
      solver->planes.all[1].fixed = fixed;
    }
    Body<2> body;
    body.kind = kind;
    body.centre = Vec<2>(0, 0.62);
    body.half = Vec<2>(0.25, 0.1);
    body.radius = 0.2;
    body.velocity.times = {0, 0.02};
    body.velocity.velocities = {Vec<2>(0, 0), Vec<2>(0, -2)};
    solver->bodies.all.push_back(body);
    double mass = 0;
    for (const auto& point : solver->points) mass += point.mass;
    while (solver->time < 0.05) solver->step(5e-4);
    Forces forces{solver->bodies.all[0].reaction.impulse, solver->planes.all[0].reaction.impulse, Vec<2>::Zero(),
                  momentum_of(*solver) - mass * solver->time * solver->options.gravity,
                  solver->bodies.all[0].reaction.work};
    if (half) forces.symmetry = solver->planes.all[1].reaction.impulse;
    forces.missing -= forces.body + forces.base + forces.symmetry;
    return forces;
  };
  for (const BodyKind kind : {BodyKind::box, BodyKind::disc}) {
    CAPTURE(int(kind));
    const Forces whole = press(false, kind, false), half = press(true, kind, false), held = press(true, kind, true);
    const double scale = std::abs(whole.body[1]);
    CHECK(whole.body[1] < -100);
    CHECK(std::abs(half.body[1] - 0.5 * whole.body[1]) < 1e-10 * scale);
    CHECK(std::abs(half.base[1] - 0.5 * whole.base[1]) < 1e-10 * scale);
    CHECK(half.work == Approx(0.5 * whole.work).epsilon(1e-10));
    for (const auto& each : {whole, half, held}) CHECK(each.missing.norm() < 1e-10 * scale);
    CHECK(std::abs(whole.body[0]) < 1e-10 * scale);
    CHECK(std::abs(half.symmetry[1]) < 1e-14 * scale);
    CHECK(half.symmetry[0] > 0.05 * scale);  // the soil pushes sideways on the plane
  }
}

TEST_CASE("energy: the balance closes, and what is left falls with the time step") {
  std::vector<double> left;
  for (const double cfl : {0.2, 0.1, 0.05}) {
    const std::array<int, 2> cells{8, 8};
    auto solver = block<2>(cells, 0.125, soil, 2000);
    solver->options.cfl = cfl;
    solver->options.gravity = Vec<2>(0, -9.81);
    enclose<2>(*solver, cells);
    set_velocity<2>(*solver, [](const Vec<2>& x) {
      return Vec<2>(0.3 * std::sin(pi * x[0]) * std::cos(pi * x[1]), 0.3 * std::cos(pi * x[0]) * std::sin(pi * x[1]));
    });
    const auto start = energy_start<2>(*solver);
    while (solver->time < 0.004) solver->step(solver->stable_step());
    const auto balance = balance_of<2>(*solver, start);
    CHECK(std::abs(balance.stress_work) > 0.2 * start.kinetic);
    left.push_back(std::abs(balance.residual) / start.kinetic);
  }
  CHECK(left[0] < 0.05);
  CHECK(left[1] < 0.8 * left[0]);
  CHECK(left[2] < 0.5 * left[0]);
}

TEST_CASE("a block slides down a plane as Coulomb says") {
  // Li et al. (2023), eq. 40, 41: 45 degrees, g = 10 sqrt(2); here the plane is level and gravity leans.
  for (const double mu : {0.1, 0.3, 0.5}) {
    CAPTURE(mu);
    auto solver = block<2>({6, 3}, 0.05, ElasticModuli{80e6, 0.3}, 2000);
    solver->options.gravity = Vec<2>(10, -10);
    solver->options.pic_fraction = 0.01;
    Body<2> base;
    base.kind = BodyKind::half_space;
    base.normal = Vec<2>(0, 1);
    base.rough = false;
    base.friction = mu;
    solver->bodies.all.push_back(base);
    while (solver->time < 0.25) solver->step(std::min(solver->stable_step(), 0.25 - solver->time));
    Vec<2> mean = Vec<2>::Zero(), way = Vec<2>::Zero();
    for (const auto& point : solver->points) {
      mean += point.velocity / double(solver->points.size());
      way += (point.position - point.first) / double(solver->points.size());
    }
    CHECK(mean[0] == Approx(10 * (1 - mu) * 0.25).epsilon(0.003));
    CHECK(way[0] == Approx(10 * (1 - mu) * 0.25 * 0.25 / 2).epsilon(0.003));
    CHECK(std::abs(mean[1]) < 0.01);
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

TEST_CASE("a body that spins keeps its shape, its spin and no stress") {
  auto solver = block<2>({4, 4}, 0.1, ElasticModuli{1e5, 0.3}, 2000);
  solver->options.pic_fraction = 0;
  const Vec<2> centre(0.2, 0.2);
  set_velocity<2>(*solver, [&](const Vec<2>& x) { return Vec<2>(-0.5 * (x[1] - 0.2), 0.5 * (x[0] - 0.2)); });
  while (solver->time < 0.4) solver->step(solver->stable_step());
  for (const auto& point : solver->points) {
    const Vec<2> r = point.first - centre, there = point.position - centre;
    const double angle = 0.5 * solver->time;
    const Vec<2> turned(std::cos(angle) * r[0] - std::sin(angle) * r[1],
                        std::sin(angle) * r[0] + std::cos(angle) * r[1]);
    CHECK((there - turned).norm() < 2e-3 * 0.28);
    CHECK(rotation_degrees<2>(point.F) == Approx(angle * 180 / pi).epsilon(0.01));
    CHECK(point.volume == Approx(0.0025).epsilon(2e-3));
  }
}

TEST_CASE("the strain of a step is the logarithm of the map that moves the points") {
  Mat<3> L;
  L << 0.2, -0.5, 0.1, 0.4, -0.3, 0.05, -0.2, 0.3, 0.1;
  for (const double size : {2e-4, 0.02, 0.3}) {
    const Mat<3> part = size * L, whole = Mat<3>::Identity() + finite_increment<3>(strain_of_step<3>(part));
    CHECK((whole * (Mat<3>::Identity() - part) - Mat<3>::Identity()).norm() < 1e-14);
    // Where the points are after the step their velocities have the gradient of which this is the inverse map.
    const Mat<3> after = carried_gradient<3>(part, 1);
    CHECK((Mat<3>::Identity() + part - (Mat<3>::Identity() - after).inverse()).norm() < 1e-14);
  }
  const double angle = 0.01;  // a rotation is no strain, whatever way it is seen from
  Mat<2> turn;
  turn << std::cos(angle) - 1, -std::sin(angle), std::sin(angle), std::cos(angle) - 1;
  const Mat<2> before = -strain_of_step<2>(-turn), after = strain_of_step<2>(-turn.transpose());
  for (const auto& W : {before, after}) {
    CHECK(std::abs(W(0, 0)) + std::abs(W(1, 1)) < 1e-15);
    CHECK(W(1, 0) == Approx(angle).epsilon(1e-12));
    CHECK(W(0, 1) == Approx(-angle).epsilon(1e-12));
  }
}

TEST_CASE("a disc that turns keeps its radius to 1e-6 a turn, its volume and its angular momentum") {
  for (const Scheme scheme : {Scheme::usf, Scheme::musl}) {
    CAPTURE(int(scheme));
    constexpr double spin = 1.5, turn = 2 * pi / spin;
    auto solver = block<2>({10, 10}, 0.1, soil, 2000);
    const Vec<2> centre(0.5, 0.5);
    auto& points = solver->points;
    std::erase_if(points, [&](const auto& point) { return (point.position - centre).norm() > 0.4; });
    solver->ranges[0].count = long(points.size());
    solver->options.scheme = scheme;
    set_velocity<2>(*solver, [&](const Vec<2>& x) { return Vec<2>(-spin * (x[1] - 0.5), spin * (x[0] - 0.5)); });
    const auto momentum = [&] {
      double sum = 0;
      for (const auto& point : points) {
        const Vec<2> r = point.position - centre;
        sum += point.mass * (r[0] * point.velocity[1] - r[1] * point.velocity[0]);
      }
      return sum;
    };
    /// Root mean square of the radius and volume over a quarter of a turn, about which the disc rings.
    const auto means = [&](double until) {
      double radius = 0, volume = 0, steps = 0;
      for (; solver->time < until; ++steps) {
        solver->step(solver->stable_step());
        double square = 0;
        for (const auto& point : points) {
          square += (point.position - centre).squaredNorm();
          volume += point.volume;
        }
        radius += std::sqrt(square / double(points.size()));
      }
      return std::pair(radius / steps, volume / steps);
    };
    const double first = momentum();
    const auto start = means(turn / 4);
    means(turn);
    const auto end = means(1.25 * turn);
    CHECK(end.first == Approx(start.first).epsilon(1e-6));
    CHECK(end.second == Approx(start.second).epsilon(2e-6));
    CHECK(momentum() == Approx(first).epsilon(1e-4));
    CHECK(std::remainder(rotation_degrees<2>(points[0].F) - solver->time * spin * 180 / pi, 360.0) ==
          Approx(0).margin(0.05));
  }
}

TEST_CASE("contact with three bodies has the same bits on any number of threads") {
  std::vector<std::vector<Point<2>>> ends;
  std::vector<double> works;
  for (const int threads : {1, 2, 3, 5}) {
    auto solver = block<2>({40, 40}, 0.025, soil, 2000, threads);
    solver->options.gravity = Vec<2>(0, -9.81);
    solver->bodies.all.push_back(half_space(Vec<2>(0, 0), Vec<2>(0, 1)));
    Body<2> footing, pipe;
    footing.centre = Vec<2>(0.25, 1.1);
    footing.half = Vec<2>(0.1, 0.1);
    pipe.kind = BodyKind::disc;
    pipe.centre = Vec<2>(0.7, 1.1);
    pipe.radius = 0.1;
    for (auto* body : {&footing, &pipe}) {
      body->velocity.times = {0};
      body->velocity.velocities = {Vec<2>(0.1, -1)};
      solver->bodies.all.push_back(*body);
    }
    for (auto& body : solver->bodies.all) body.at_surface = &body != &solver->bodies.all[1];
    for (int k = 0; k < 150; ++k) solver->step(solver->stable_step());
    ends.push_back(solver->points);
    works.push_back(solver->ledger.nodal_kinetic);
    for (const auto& body : solver->bodies.all) {
      CHECK(body.reaction.impulse.norm() > 1);
      works.push_back(body.reaction.work);
    }
  }
  for (std::size_t run = 1; run < ends.size(); ++run) {
    for (std::size_t k = 0; k < 4; ++k) CHECK(works[4 * run + k] == works[k]);
    for (std::size_t k = 0; k < ends[0].size(); ++k) {
      REQUIRE(ends[run][k].position == ends[0][k].position);
      REQUIRE(ends[run][k].stress == ends[0][k].stress);
    }
  }
}

TEST_CASE("any number of threads gives the same bits, on a grid that grows") {
  std::vector<std::vector<Point<2>>> ends;
  for (const int threads : {1, 2, 3, 5}) {
    auto solver = block<2>({20, 40}, 0.05, soil, 2000, threads);
    solver->options.gravity = Vec<2>(0, -9.81);
    solver->planes.all.push_back(roller<2>(0, 0, true));
    set_velocity<2>(*solver, [](const Vec<2>& x) { return Vec<2>(40 * x[0], 3 * std::sin(5 * x[0]) - 60 * x[1]); });
    const auto box = solver->grid.count;
    for (int k = 0; k < 150; ++k) solver->step(1e-4);
    CHECK(solver->grid.count != box);
    ends.push_back(solver->points);
  }
  for (std::size_t run = 1; run < ends.size(); ++run) {
    for (std::size_t k = 0; k < ends[0].size(); ++k) {
      REQUIRE(ends[run][k].position == ends[0][k].position);
      REQUIRE(ends[run][k].velocity == ends[0][k].velocity);
      REQUIRE(ends[run][k].stress == ends[0][k].stress);
    }
  }
}

TEST_CASE("a gate holds until it is removed") {
  const std::array<int, 2> cells{4, 4};
  auto solver = block<2>(cells, 0.1, soil, 2000);
  enclose<2>(*solver, cells);
  solver->planes.all[1].removed_at = 0.01;
  for (auto& point : solver->points) point.stress = -1e4 * Mat<2>::Identity();
  while (solver->time < 0.0099) solver->step(1e-4);
  for (const auto& point : solver->points) CHECK((point.position - point.first).norm() < 1e-12);
  while (solver->time < 0.02) solver->step(1e-4);
  CHECK(solver->points.back().velocity[0] > 0.01);
}

TEST_CASE("a prescribed velocity is linear between its times, its way the integral") {
  VelocityHistory<2> history;
  history.times = {0, 1, 3};
  history.velocities = {Vec<2>(0, 0), Vec<2>(2, 0), Vec<2>(2, -4)};
  CHECK(history.at(0.5) == Vec<2>(1, 0));
  CHECK(history.at(9) == Vec<2>(2, -4));
  CHECK(history.way(1) == Vec<2>(1, 0));
  CHECK(history.way(2)[0] == Approx(3));
  CHECK(history.way(2)[1] == Approx(-1));
  CHECK(history.way(4)[1] == Approx(-8));
}
