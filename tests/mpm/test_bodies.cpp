// What rigid bodies do to soil that more than one of them holds, and to the step.
#include "tests/catch.hpp"
#include "tests/mpm/blocks.hpp"

using namespace mpm;
using namespace mpm::test;

TEST_CASE("a block between smooth half-spaces: walls push sideways alone, and all reactions carry its weight") {
  auto solver = block<2>({10, 5}, 0.1, ElasticModuli{1e6, 0.3}, 2000);
  solver->options.gravity = Vec<2>(0, -9.81);
  solver->bodies.all = {half_space({0, 0}, {0, 1}), half_space({0, 0}, {1, 0}), half_space({1, 0}, {-1, 0})};
  const auto start = energy_start<2>(*solver);
  double mass = 0;
  Vec<2> momentum = Vec<2>::Zero(), pushed = Vec<2>::Zero();
  for (int k = 0; k < 150; ++k) solver->step(solver->stable_step());
  for (const auto& point : solver->points) {
    mass += point.mass;
    momentum += point.mass * point.velocity;
  }
  const double weight = mass * 9.81 * solver->time;
  for (const auto& body : solver->bodies.all) pushed += body.reaction.impulse;
  CHECK((pushed - Vec<2>(0, weight) - momentum).norm() < 1e-12 * weight);
  const auto& walls = solver->bodies.all;
  CHECK(walls[0].reaction.impulse[1] > 0.5 * weight);
  CHECK(std::abs(walls[0].reaction.impulse[0]) < 1e-14 * weight);
  CHECK(walls[1].reaction.impulse[0] > 0.05 * weight);
  for (const int k : {1, 2}) {
    CHECK(walls[k].reaction.impulse[1] == 0);
    CHECK(std::abs(walls[k].reaction.work) < 1e-3 * start.potential);  // they push across the velocity of the soil
  }
  // A wall that is there twice finds nothing left to do, and nothing is booked again.
  auto twice = block<2>({10, 5}, 0.1, ElasticModuli{1e6, 0.3}, 2000);
  twice->options = solver->options;
  twice->bodies.all = solver->bodies.all;
  for (auto& body : twice->bodies.all) body.reaction = {};
  twice->bodies.all.push_back(half_space({0, 0}, {0, 1}));
  for (int k = 0; k < 150; ++k) twice->step(twice->stable_step());
  CHECK(twice->bodies.all[3].reaction.impulse == Vec<2>::Zero());
  CHECK(twice->bodies.all[0].reaction.impulse == walls[0].reaction.impulse);
  CHECK(energy_balance<2>(*twice, start).residual == energy_balance<2>(*solver, start).residual);
}

TEST_CASE("a body faster than any wave moves a fifth of a cell a step, one at usual speeds leaves the step as it is") {
  auto solver = block<2>({4, 4}, 0.1, ElasticModuli{1e6, 0.3}, 2000);
  const double alone = solver->stable_step();
  Body<2> ram;
  ram.shape = Box<2>{Vec<2>(0.1, 0.1)};
  ram.centre = Vec<2>(0.2, 0.55);
  ram.velocity.times = {0, 1e-3};
  ram.velocity.velocities = {Vec<2>(0, 0), Vec<2>(0, -2)};
  solver->bodies.all.push_back(ram);
  CHECK(solver->stable_step() == alone);
  solver->bodies.all[0].velocity.velocities = {Vec<2>(0, -1000), Vec<2>(0, -1000)};
  CHECK(solver->stable_step() == Approx(0.2 * 0.1 / 1000));
  for (int k = 0; k < 20; ++k) solver->step(solver->stable_step());
  double down = 0;
  for (const auto& point : solver->points) down = std::min(down, point.velocity[1]);
  CHECK(down < -300);  // it did not pass through
}

TEST_CASE("the least displacement of a prescribed velocity is found where it changes sign, too") {
  VelocityHistory<2> history;
  history.times = {0, 1, 3};
  history.velocities = {Vec<2>(0, -2), Vec<2>(0, -2), Vec<2>(1, 2)};
  CHECK(history.least_displacement(1, 9) == Approx(-3));  // at 2 s
  CHECK(history.least_displacement(1, 1.5) == Approx(history.displacement(1.5)[1]));
  CHECK(history.least_displacement(0, 9) == 0);
  CHECK(VelocityHistory<2>().least_displacement(1, 9) == 0);
}

TEST_CASE("a block slides down a plane as Coulomb says") {
  // Li et al. (2023), eq. 40, 41: 45 degrees, g = 10 sqrt(2); here the plane is level and gravity leans.
  for (const double mu : {0.1, 0.3, 0.5}) {
    CAPTURE(mu);
    auto solver = block<2>({6, 3}, 0.05, ElasticModuli{80e6, 0.3}, 2000);
    solver->options.gravity = Vec<2>(10, -10);
    solver->options.pic_fraction = 0.01;
    Body<2> base;
    base.shape = HalfSpace<2>{Vec<2>(0, 1)};
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

TEST_CASE("a gate holds until it is removed") {
  const std::array<int, 2> cells{4, 4};
  auto solver = block<2>(cells, 0.1, ElasticModuli{1e7, 0.25}, 2000);
  enclose<2>(*solver, cells);
  solver->planes.all[1].removed_at = 0.01;
  for (auto& point : solver->points) point.stress = -1e4 * Mat<2>::Identity();
  while (solver->time < 0.0099) solver->step(1e-4);
  for (const auto& point : solver->points) CHECK((point.position - point.first).norm() < 1e-12);
  while (solver->time < 0.02) solver->step(1e-4);
  CHECK(solver->points.back().velocity[0] > 0.01);
}

TEST_CASE("a prescribed velocity is linear between its times, its displacement the integral") {
  VelocityHistory<2> history;
  history.times = {0, 1, 3};
  history.velocities = {Vec<2>(0, 0), Vec<2>(2, 0), Vec<2>(2, -4)};
  CHECK(history.at(0.5) == Vec<2>(1, 0));
  CHECK(history.at(9) == Vec<2>(2, -4));
  CHECK(history.displacement(1) == Vec<2>(1, 0));
  CHECK(history.displacement(2)[0] == Approx(3));
  CHECK(history.displacement(2)[1] == Approx(-1));
  CHECK(history.displacement(4)[1] == Approx(-8));
}
