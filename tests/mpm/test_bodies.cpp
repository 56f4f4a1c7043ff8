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
    CHECK(std::abs(walls[k].reaction.work) < 1e-3 * start.potential);  // they push across the way of the soil
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
  CHECK(balance_of<2>(*twice, start).residual == balance_of<2>(*solver, start).residual);
}

TEST_CASE("a body faster than any wave moves a fifth of a cell a step, one at usual speeds leaves the step as it is") {
  auto solver = block<2>({4, 4}, 0.1, ElasticModuli{1e6, 0.3}, 2000);
  const double alone = solver->stable_step();
  Body<2> ram;
  ram.half = Vec<2>(0.1, 0.1);
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

TEST_CASE("the least way of a prescribed velocity is found where it turns, too") {
  VelocityHistory<2> history;
  history.times = {0, 1, 3};
  history.velocities = {Vec<2>(0, -2), Vec<2>(0, -2), Vec<2>(1, 2)};
  CHECK(history.least_way(1, 9) == Approx(-3));  // at 2 s
  CHECK(history.least_way(1, 1.5) == Approx(history.way(1.5)[1]));
  CHECK(history.least_way(0, 9) == 0);
  CHECK(VelocityHistory<2>().least_way(1, 9) == 0);
}
