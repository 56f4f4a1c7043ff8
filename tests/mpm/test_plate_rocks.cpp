// Plates under pressure on rocks: at rest on a column of them, in collisions, and beside soil.
#include "tests/catch.hpp"
#include "tests/mpm/plates.hpp"

using namespace mpm;
using namespace mpm::test;

namespace {

/// Three rocks in a row from the floor to the plate, of radius 0.1 m.
template <int D>
std::unique_ptr<Solver<D>> rocks_under_plate(double pressure, double mass, double area, double restitution) {
  auto solver = std::make_unique<Solver<D>>(1);
  solver->grid.cell.setConstant(0.1);
  auto rocks = std::make_unique<Rocks<D>>();
  rocks->materials = {{1e8, 0.25, 0.4, restitution}};
  const auto shape = RockShape<D>::sphere(0.1);
  for (int k = 0; k < 3; ++k) add_rock<D>(*rocks, shape, 2600, (0.1 + 0.2 * k) * Vec<D>::Unit(D - 1));
  solver->planes.all = {roller<D>(D - 1, 0, true)};
  solver->bodies.all = {plate_over<D>(D - 1, 0.6, pressure, mass, area)};
  rocks->prepare_walls(solver->bodies);
  put_rocks<D>(*solver, std::move(rocks));
  return solver;
}

/// Hertz: F = pi/4 E* delta for cylinders, 4/3 E* sqrt(r*) delta^1.5 for spheres; r* = r at walls, r/2 among them.
template <int D>
double overlap_of(double force, double r) {
  const double e_star = 1e8 / (2 * (1 - 0.0625));
  return D == 2 ? force / (pi / 4 * e_star) : std::pow(force / (4.0 / 3 * e_star * std::sqrt(r)), 2.0 / 3);
}

template <int D>
void expect_carried(double mass_ratio) {
  constexpr double p = 1e5, area = 0.02, force = p * area;
  auto solver = rocks_under_plate<D>(p, 1, area, 0.2);
  auto& body = solver->bodies.all[0];
  body.plate->mass = mass_ratio * solver->rocks->all[0].body.mass;
  for (int step = 0; step < (mass_ratio > 1 ? 8000 : 600); ++step) solver->step(1e-3);
  CAPTURE(D, mass_ratio);
  const auto& rocks = *solver->rocks;
  CHECK(rocks.touching == 4);
  for (const auto& pair : rocks.pairs) {
    if (pair.contact.overlap > 0)
      CHECK(pair.constants.normal_force(pair.contact.overlap) == Approx(force).epsilon(1e-3));
  }
  CHECK(rocks.wall_force[0][D - 1] == Approx(-force).epsilon(1e-3));
  CHECK(rocks.wall_force[1][D - 1] == Approx(force).epsilon(1e-3));
  const auto before = rocks.wall_impulse;
  for (int step = 0; step < 20; ++step) solver->step(1e-3);
  CHECK((rocks.wall_impulse[1] - before[1])[D - 1] == Approx(0.02 * force).epsilon(1e-3));
  CHECK(body.plate->displacement ==
        Approx(2 * overlap_of<D>(force, 0.1) + 2 * overlap_of<D>(force, 0.05)).epsilon(1e-3));
}

}  // namespace

TEST_CASE("a plate on a column of rocks is carried by each of its contacts, light or heavy") {
  for (const double mass_ratio : {0.01, 1.0, 20.0}) {
    expect_carried<2>(mass_ratio);
    expect_carried<3>(mass_ratio);
  }
}

TEST_CASE("a plate takes part in the sub-steps of a collision with a rock, which keeps momentum and its restitution") {
  for (const double e : {1.0, 0.5}) {
    for (const double mass_ratio : {0.1, 1.0, 10.0}) {
      auto solver = rocks_under_plate<3>(0, 1, 0.02, e);
      auto& rocks = *solver->rocks;
      rocks.all.resize(1);
      auto& rock = rocks.all[0].body;
      rock.centre[2] = 0.49;
      auto& plate = *solver->bodies.all[0].plate;
      const double m = rock.mass, mass = plate.mass = mass_ratio * m;
      plate.velocity = 5;
      CAPTURE(e, mass_ratio);
      // One step as long as the collision or longer; the floor is not reached.
      const long before = rocks.sub_steps;
      double time = 0;
      while (time < 0.03 && rock.centre[2] > 0.15) {
        solver->step(6e-3);
        time += 6e-3;
      }
      CHECK(rocks.sub_steps - before > 20);
      const double common = mass * 5 / (mass + m);
      CHECK(-rock.velocity[2] == Approx(common * (1 + e)).epsilon(0.01));
      CHECK(mass * plate.velocity - m * rock.velocity[2] == Approx(mass * 5).epsilon(1e-12));
    }
  }
}

TEST_CASE("a plate that soil and a rock carry side by side settles as their stiffnesses together") {
  constexpr double load = 6e3;
  auto solver = block<2>({3, 3}, 0.1, soil, 2000);
  // The soil meets the plate with the rocks' force of the step before: dt^2/M of that force is between the two.
  solver->options.cfl = 0.1;
  solver->planes.all = {roller<2>(0, 0, true), roller<2>(1, 0, true)};
  solver->bodies.all = {plate_over<2>(1, 0.3, 0, 30, 0.8)};
  auto& body = solver->bodies.all[0];
  body.plate->pressure = {{0, 0.3}, {0, load / 0.8}};
  auto rocks = std::make_unique<Rocks<2>>();
  rocks->materials = {{5e7, 0.25, 0.4, 0.5}};
  add_rock<2>(*rocks, RockShape<2>::sphere(0.15), 2600, Vec<2>(0.65, 0.15));
  rocks->prepare_walls(solver->bodies);
  put_rocks<2>(*solver, std::move(rocks));
  while (solver->time < 0.4) solver->step(solver->stable_step());
  double settled = 0, samples = 0;
  const double start = solver->time;
  const Vec<2> on_soil = body.reaction.impulse, on_plate = solver->rocks->wall_impulse[2];
  while (solver->time < 0.5) {
    solver->step(solver->stable_step());
    settled += body.plate->displacement;
    ++samples;
  }
  // Soil in plane strain, free to one side: E/(1 - nu^2); the disc between two walls: half of pi/4 E*
  // (rocks/contact.hpp).
  const double of_soil = soil.young / (1 - 0.0625), of_rock = pi / 8 * 5e7 / (2 * (1 - 0.0625));
  CHECK(settled / samples == Approx(load / (of_soil + of_rock)).epsilon(0.01));
  const double took = solver->time - start;
  CHECK(-(body.reaction.impulse - on_soil)[1] / took == Approx(load * of_soil / (of_soil + of_rock)).epsilon(0.01));
  CHECK((solver->rocks->wall_impulse[2] - on_plate)[1] / took ==
        Approx(load * of_rock / (of_soil + of_rock)).epsilon(0.01));
}

TEST_CASE("a plate that has a way to go to rocks is met by them, also under a pressure that rises from nothing") {
  // 3 ms at 25,000 m/s^2 take a light plate over the gap; a step must not take it through the rocks.
  constexpr double p = 1e5, area = 0.02, mass = 0.08, gap = 0.1;
  const TimeHistory pressure = GENERATE(TimeHistory{{0}, {p}}, TimeHistory{{0, 1e-4}, {0, p}});
  auto solver = rocks_under_plate<3>(p, mass, area, 0.2);
  auto& body = solver->bodies.all[0];
  body.centre[2] += gap;
  body.plate->pressure = pressure;
  CHECK(solver->stable_step() <= std::sqrt(2 * 0.011 * 0.1 / (p * area / mass)));
  double lowest = 1e300;
  while (solver->time < 1) {
    solver->step(solver->stable_step());
    lowest = std::min(lowest, body.centre_at(solver->time)[2]);
  }
  CHECK(solver->rocks->touching == 4);
  CHECK(lowest > 0.5);
  const double pressed = 2 * overlap_of<3>(p * area, 0.1) + 2 * overlap_of<3>(p * area, 0.05);
  CHECK(body.plate->displacement == Approx(gap + pressed).epsilon(1e-3));
  CHECK(solver->rocks->wall_force[0][2] == Approx(-p * area).epsilon(1e-2));
}
