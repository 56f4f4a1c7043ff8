// Finite strains and rotations: of the map that a step makes, and of bodies that turn.
#include "tests/catch.hpp"
#include "tests/mpm/blocks.hpp"

using namespace mpm;
using namespace mpm::test;

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
    solver->groups[0].count = long(points.size());
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
