// Rocks and soil: momentum, angular momentum, weight.
#include "tests/catch.hpp"
#include "tests/mpm/rocks.hpp"

using namespace mpm;
using namespace mpm::test;

namespace {

/// A cube of 4 x 4 x 4 cells of elastic soil at rest, and a ball that flies at its top.
std::unique_ptr<Solver<3>> ball_on_cube(bool ghosts) {
  auto solver = block<3>({4, 4, 4}, 0.1, ElasticModuli{1e6, 0.3}, 2000);
  auto rocks = std::make_unique<Rocks<3>>();
  rocks->materials = {{1e7, 0.2, 0.3, 0.5}};
  rocks->soil.ghosts = ghosts;
  add_rock<3>(*rocks, RockShape<3>::sphere(0.15), 2600, Vec<3>(0.25, 0.2, 0.56), Vec<3>(0.5, 0, -1));
  put_rocks<3>(*solver, std::move(rocks));
  return solver;
}

}  // namespace

TEST_CASE("what a rock loses of momentum, the soil gets") {
  for (const bool ghosts : {false, true}) {
    CAPTURE(ghosts);
    auto solver = ball_on_cube(ghosts);
    const Vec<3> before = momentum_of<3>(*solver->rocks);
    double most = 0;
    while (solver->time < 0.05) {
      solver->step(solver->stable_step());
      most = std::max(most, (momentum_of<3>(*solver) + momentum_of<3>(*solver->rocks) - before).norm());
    }
    CHECK(momentum_of<3>(*solver).norm() > 0.3 * before.norm());
    CHECK(most < 1e-12 * before.norm());
    CHECK(solver->rocks->all[0].body.spin()[1] > 0);  // friction turns it forward
  }
}

TEST_CASE("the soil carries the weight of a rock that rests on it") {
  for (const bool ghosts : {false, true}) {
    CAPTURE(ghosts);
    auto solver = block<3>({6, 6, 4}, 0.1, ElasticModuli{2e6, 0.3}, 2000);
    for (int i = 0; i < 3; ++i) {
      solver->planes.all.push_back(roller<3>(i, 0, true));
      if (i < 2) solver->planes.all.push_back(roller<3>(i, 6, false));
    }
    solver->options.pic_fraction = 0.1;
    solver->options.gravity = Vec<3>(0, 0, -9.81);
    auto rocks = std::make_unique<Rocks<3>>();
    rocks->materials = {{1e8, 0.2, 0.3, 0.5}};
    rocks->soil.ghosts = ghosts;
    add_rock<3>(*rocks, RockShape<3>::sphere(0.15), 2600, Vec<3>(0.3, 0.3, 0.4 + 0.15));
    put_rocks<3>(*solver, std::move(rocks));
    while (solver->time < 3) solver->step(solver->stable_step());
    const double weight = solver->rocks->all[0].body.mass * 9.81, from = solver->time;
    const Vec<3> before = solver->rocks->all[0].soil_impulse;
    const double place = solver->rocks->all[0].body.centre[2];
    while (solver->time < 3.5) solver->step(solver->stable_step());
    const Vec<3> force = (solver->rocks->all[0].soil_impulse - before) / (solver->time - from);
    CHECK(force[2] == Approx(weight).epsilon(1e-3));
    CHECK(std::abs(force[0]) < 1e-3 * weight);
    CHECK(solver->rocks->all[0].body.centre[2] == Approx(place).margin(1e-4));
  }
}
