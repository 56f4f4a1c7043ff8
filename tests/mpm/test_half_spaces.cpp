// Contact at the surface of half-spaces: weight, sliding, leaving, across an axis and oblique.
#include "tests/catch.hpp"
#include "tests/mpm/blocks.hpp"

using namespace mpm;
using namespace mpm::test;

TEST_CASE("a block at rest on the surface of a half-space stays so, with quadratic functions and with GIMP") {
  for (const Shape shape : {Shape::bspline, Shape::gimp}) {
    for (const double height : {0.0, 0.037}) {  // on a row of nodes, and between two
      auto solver = block<2>({5, 10}, 0.1, ElasticModuli{1e6, 0.3}, 2000);
      solver->options.gravity = Vec<2>(0, -9.81);
      solver->options.shape = solver->bodies.shape = shape;
      solver->planes.all = {roller<2>(0, 0, true), roller<2>(0, 5, false)};
      solver->bodies.all = {half_space({0, height}, {0, 1})};
      solver->bodies.all[0].at_surface = true;
      double mass = 0;
      for (auto& point : solver->points) {  // under its own weight
        point.position[1] += height;
        const double p = 2000 * 9.81 * (1 + height - point.position[1]);
        point.stress = -p * Vec<2>(0.3 / 0.7, 1).asDiagonal();
        point.stress_zz = 0;
        mass += point.mass;
      }
      const auto start = energy_start<2>(*solver);
      const auto first = solver->points;
      while (solver->time < 3) solver->step(solver->stable_step());
      CAPTURE(int(shape), height);
      const double weight = mass * 9.81;
      CHECK(solver->bodies.all[0].reaction.impulse[1] == Approx(weight * solver->time).epsilon(1e-3));
      double farthest = 0;
      for (std::size_t k = 0; k < first.size(); ++k) {
        farthest = std::max(farthest, (solver->points[k].position - first[k].position).norm());
        CHECK(solver->points[k].stress(1, 1) == Approx(first[k].stress(1, 1)).margin(0.03 * 2000 * 9.81));
      }
      CHECK(farthest < 0.01 * 2000 * 9.81 / 1e6);  // of the settlement that the weight would make
      CHECK(std::abs(energy_balance<2>(*solver, start).residual) < 1e-4 * start.potential);
    }
  }
}

TEST_CASE("on a surface a block slides as Coulomb says, and leaves it without being held") {
  for (const double mu : {0.1, 0.5}) {
    CAPTURE(mu);
    auto solver = block<2>({6, 3}, 0.05, ElasticModuli{80e6, 0.3}, 2000);
    solver->options.gravity = Vec<2>(10, -10);
    solver->options.pic_fraction = 0.01;
    solver->bodies.all = {half_space({0, 0}, {0, 1})};
    solver->bodies.all[0].friction = mu;
    solver->bodies.all[0].at_surface = true;
    while (solver->time < 0.25) solver->step(std::min(solver->stable_step(), 0.25 - solver->time));
    Vec<2> mean = Vec<2>::Zero();
    double mass = 0;
    for (const auto& point : solver->points) {
      mean += point.velocity / double(solver->points.size());
      mass += point.mass;
    }
    CHECK(mean[0] == Approx(10 * (1 - mu) * 0.25).epsilon(0.003));
    CHECK(std::abs(mean[1]) < 0.01);
    CHECK(-solver->bodies.all[0].reaction.impulse[0] == Approx(mu * mass * 10 * 0.25).epsilon(0.01));

    solver->options.gravity.setZero();
    set_velocity<2>(*solver, [](const Vec<2>&) { return Vec<2>(0, 1); });
    const Vec<2> before = solver->bodies.all[0].reaction.impulse;
    double momentum = 0;
    for (int k = 0; k < 200; ++k) solver->step(solver->stable_step());
    for (const auto& point : solver->points) momentum += point.mass * point.velocity[1];
    const double pushed = solver->bodies.all[0].reaction.impulse[1] - before[1];
    CHECK(pushed >= 0);  // what was pressed springs back
    CHECK(momentum == Approx(mass + pushed).epsilon(1e-9));
  }
}

TEST_CASE("on an oblique half-space a block slides as Coulomb says, and its weight is on it") {
  for (const double degrees : {10.0, 30.0, 45.0, 70.0}) {
    const double angle = degrees * pi / 180;
    const Vec<2> down(std::cos(angle), -std::sin(angle)), normal(std::sin(angle), std::cos(angle));
    for (const double mu : {0.1, 0.5}) {
      CAPTURE(degrees, mu);
      auto solver = block<2>({12, 6}, 0.05, ElasticModuli{80e6, 0.3}, 2000);
      // The plane leans against the grid; gravity has 10 m/s^2 across it and along it.
      solver->options.gravity = 10 * down - 10 * normal;
      solver->options.pic_fraction = 0.01;
      double mass = 0;
      for (auto& point : solver->points) {
        point.position = point.position[0] * down + point.position[1] * normal;
        mass += point.mass;
      }
      solver->bodies.all = {half_space({0, 0}, normal)};
      solver->bodies.all[0].friction = mu;
      solver->bodies.all[0].at_surface = true;
      while (solver->time < 0.25) solver->step(std::min(solver->stable_step(), 0.25 - solver->time));
      Vec<2> mean = Vec<2>::Zero();
      for (const auto& point : solver->points) mean += point.velocity / double(solver->points.size());
      CHECK(mean.dot(down) == Approx(10 * (1 - mu) * 0.25).epsilon(0.01));
      CHECK(std::abs(mean.dot(normal)) < 0.01);
      const Vec<2> pushed = solver->bodies.all[0].reaction.impulse / (mass * 10 * 0.25);
      CHECK(pushed.dot(normal) == Approx(1).epsilon(0.01));
      CHECK(-pushed.dot(down) == Approx(mu).epsilon(0.01));
    }
  }
}

TEST_CASE("a block at rest on an oblique half-space keeps the stress of its weight") {
  for (const double degrees : {10.0, 30.0, 45.0, 70.0}) {
    CAPTURE(degrees);
    const double angle = degrees * pi / 180;
    const Vec<2> down(std::cos(angle), -std::sin(angle)), normal(std::sin(angle), std::cos(angle));
    auto solver = block<2>({10, 10}, 0.1, ElasticModuli{1e6, 0.3}, 2000);
    solver->options.gravity = -10 * normal;
    for (auto& point : solver->points) {
      const double p = 2000 * 10 * (1 - point.position[1]);
      point.position = point.position[0] * down + point.position[1] * normal;
      point.stress = -p * normal * normal.transpose();
      point.stress_zz = -0.3 * p;
    }
    const auto first = solver->points;
    solver->bodies.all = {half_space({0, 0}, normal)};
    solver->bodies.all[0].at_surface = true;
    while (solver->time < 1) solver->step(solver->stable_step());
    double sum = 0;
    for (std::size_t k = 0; k < first.size(); ++k) {
      const double error = normal.dot((solver->points[k].stress - first[k].stress) * normal) / (2000 * 10);
      sum += error * error / double(first.size());
    }
    CHECK(std::sqrt(sum) < 0.1);  // of rho g h; at nodes 0.13 to 0.54
  }
}

TEST_CASE("oblique half-spaces let nothing through, with cells of unequal sides and in space") {
  for (const Vec<2>& leaning : {Vec<2>(0.7, 0.714), Vec<2>(0.5, 0.866), Vec<2>(-0.95, 0.3)}) {
    const Vec<2> normal = leaning.normalized();
    auto solver = block<2>({6, 24}, 0.1, ElasticModuli{1e6, 0.3}, 2000);
    solver->grid.cell[1] = 0.025;
    double nearest = 1e300;
    for (auto& point : solver->points) {
      point.position[1] /= 4;
      point.half[1] /= 4;
      point.volume /= 4;
      point.mass /= 4;
      nearest = std::min(nearest, point.position.dot(normal));
    }
    solver->bodies.all = {half_space((nearest - 0.06) * normal, normal)};
    solver->bodies.all[0].at_surface = true;
    set_velocity<2>(*solver, [&](const Vec<2>&) { return Vec<2>(-2 * normal); });
    while (solver->time < 0.1) solver->step(solver->stable_step());
    double deepest = 1e300;
    for (const auto& point : solver->points) deepest = std::min(deepest, point.position.dot(normal) - nearest + 0.06);
    CAPTURE(leaning.transpose());
    CHECK(deepest > -0.025);  // it would have gone 0.14 m
  }
  const Vec<3> normal = Vec<3>(0.3, 0.5, 0.8).normalized();
  auto solver = block<3>({4, 4, 4}, 0.1, ElasticModuli{1e6, 0.3}, 2000);
  Body<3> slope;
  slope.shape = HalfSpace<3>{normal};
  slope.rough = false;
  slope.at_surface = true;
  slope.centre = -0.02 * normal;
  solver->bodies.all = {slope};
  set_velocity<3>(*solver, [&](const Vec<3>&) { return Vec<3>(-2 * normal); });
  double mass = 0, deepest = 1e300;
  while (solver->time < 0.1) solver->step(solver->stable_step());
  Vec<3> momentum = Vec<3>::Zero();
  for (const auto& point : solver->points) {
    mass += point.mass;
    momentum += point.mass * point.velocity;
    deepest = std::min(deepest, (point.position - slope.centre).dot(normal));
  }
  CHECK(deepest > -0.025);
  const Vec<3> pushed = solver->bodies.all[0].reaction.impulse;
  CHECK((momentum - pushed + 2 * mass * normal).norm() < 1e-10 * mass);
  CHECK((pushed - pushed.dot(normal) * normal).norm() < 1e-10 * mass);  // smooth
}
