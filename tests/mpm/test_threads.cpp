// Results do not depend on the number of threads.
#include "tests/catch.hpp"
#include "tests/mpm/blocks.hpp"

using namespace mpm;
using namespace mpm::test;

TEST_CASE("contact with three bodies has the same bits on any number of threads") {
  std::vector<std::vector<Point<2>>> ends;
  std::vector<double> works;
  for (const int threads : {1, 2, 3, 5}) {
    auto solver = block<2>({40, 40}, 0.025, soil, 2000, threads);
    solver->options.gravity = Vec<2>(0, -9.81);
    solver->bodies.all.push_back(half_space(Vec<2>(0, 0), Vec<2>(0, 1)));
    Body<2> footing, pipe;
    footing.centre = Vec<2>(0.25, 1.1);
    footing.shape = Box<2>{Vec<2>(0.1, 0.1)};
    pipe.shape = Disc<2>{0.1};
    pipe.centre = Vec<2>(0.7, 1.1);
    for (auto* body : {&footing, &pipe}) {
      body->velocity.times = {0};
      body->velocity.velocities = {Vec<2>(0.1, -1)};
      solver->bodies.all.push_back(*body);
    }
    for (auto& body : solver->bodies.all) body.at_surface = &body != &solver->bodies.all[1];
    for (int k = 0; k < 150; ++k) solver->step(solver->stable_step());
    ends.push_back(solver->points);
    works.push_back(solver->nodal_energy);
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
