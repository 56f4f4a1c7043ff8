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
    solver->options.pic_fraction = 0.5;  // comes to rest soon
    solver->options.gravity = Vec<3>(0, 0, -9.81);
    auto rocks = std::make_unique<Rocks<3>>();
    rocks->materials = {{1e8, 0.2, 0.3, 0.5}};
    rocks->soil.ghosts = ghosts;
    add_rock<3>(*rocks, RockShape<3>::sphere(0.15), 2600, Vec<3>(0.3, 0.3, 0.4 + 0.15));
    put_rocks<3>(*solver, std::move(rocks));
    while (solver->time < 1.8) solver->step(solver->stable_step());
    const double weight = solver->rocks->all[0].body.mass * 9.81, from = solver->time;
    const Vec<3> before = solver->rocks->all[0].soil_impulse;
    const double place = solver->rocks->all[0].body.centre[2];
    while (solver->time < 2.1) solver->step(solver->stable_step());
    const Vec<3> force = (solver->rocks->all[0].soil_impulse - before) / (solver->time - from);
    CHECK(force[2] == Approx(weight).epsilon(1e-3));
    CHECK(std::abs(force[0]) < 1e-3 * weight);
    CHECK(solver->rocks->all[0].body.centre[2] == Approx(place).margin(1e-4));
  }
}

namespace {

/// J, over a run to a time (s).
struct Books {
  double gained = 0;   ///< by soil and rock together: kinetic energy, stress, mapping
  double came = 0;     ///< of what holds the rock, and of the boundaries
  double lost = 0;     ///< to contact of soil and rock, with what springs of ghosts hold
  double largest = 0;  ///< what rock, soil and boundaries turned over
};

Books books_of(Solver<3>& solver, double until) {
  const auto start = energy_start<3>(solver);
  auto& rocks = *solver.rocks;
  const double flew = rocks.all[0].body.kinetic();
  while (solver.time < until) solver.step(solver.stable_step());
  const auto soil = energy_balance<3>(solver, start);
  const auto rock = rocks.energy(solver.options.gravity);
  Books books;
  books.gained = soil.kinetic - start.kinetic + soil.stress_work + soil.mapping_loss + rock.kinetic - flew;
  books.came = rock.wall_work + soil.boundary_work - rocks.work_on_soil;
  books.lost = rocks.surface_loss + rocks.ghost_loss + rocks.ghost_mapping + rocks.ghost_springs();
  books.largest = std::max({flew, std::abs(rock.wall_work), soil.stress_work});
  return books;
}

}  // namespace

TEST_CASE("what contact with soil takes of a rock that drops into it closes the energy of both") {
  for (const bool ghosts : {false, true}) {
    CAPTURE(ghosts);
    auto solver = ball_on_cube(ghosts);
    const auto books = books_of(*solver, 0.05);
    CHECK(books.largest > 10);
    CHECK(books.lost > (ghosts ? 0 : 0.02) * books.largest);  // soil that a rock meets takes on its speed
    CHECK(std::abs(books.gained + books.lost - books.came) < 0.02 * books.largest);
  }
}

TEST_CASE("what contact with soil takes of a rock that is dragged through it closes the energy of both") {
  for (const bool ghosts : {false, true}) {
    CAPTURE(ghosts);
    double lost[2] = {};
    for (const bool smooth : {false, true}) {
      if (ghosts && smooth) continue;
      auto solver = block<3>({6, 4, 4}, 0.1, ElasticModuli{1e6, 0.3}, 2000);
      enclose<3>(*solver, {6, 4, 12});
      auto rocks = std::make_unique<Rocks<3>>();
      rocks->materials = {{1e7, 0.2, 0.5, 0.5}};
      rocks->soil.ghosts = ghosts;
      rocks->soil.friction = smooth ? 0 : 0.5;
      auto& body =
          add_rock<3>(*rocks, RockShape<3>::sphere(0.15), 2600, Vec<3>(0.2, 0.2, 0.55), Vec<3>(1, 0, -0.25)).body;
      body.free.setZero();
      body.turns = false;
      put_rocks<3>(*solver, std::move(rocks));
      const auto books = books_of(*solver, 0.15);
      CHECK(books.came > 0);
      CHECK(std::abs(books.gained + books.lost - books.came) < 0.02 * books.largest);
      lost[smooth] = books.lost;
    }
    // Friction of 0.5 under what presses takes a part that nothing else does.
    CHECK(lost[0] > 1.2 * lost[1]);
  }
}
