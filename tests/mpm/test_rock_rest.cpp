// Rocks at rest, rocks that are held, and a round superquadric among spheres.
#include "tests/catch.hpp"
#include "tests/mpm/rocks.hpp"

using namespace mpm;
using namespace mpm::test;

namespace {

const Vec<3> gravity_down(0, 0, -9.81);

Wall<3> wall_at(const Vec<3>& point, const Vec<3>& normal, double friction) {
  Wall<3> wall;
  wall.point = point;
  wall.normal = normal;
  wall.follows_material = false;
  wall.friction = friction;
  return wall;
}

/// Two balls or two round superquadrics that fall on soil, the second onto the first.
std::unique_ptr<Solver<3>> falling_rocks(bool superquadric, bool ghosts) {
  auto solver = block<3>({4, 4, 3}, 0.1, ElasticModuli{1e6, 0.3}, 2000);
  enclose<3>(*solver, {4, 4, 12});
  solver->options.gravity = gravity_down;
  auto rocks = std::make_unique<Rocks<3>>();
  rocks->materials = {{1e7, 0.2, 0.3, 0.5}};
  rocks->soil.ghosts = ghosts;
  const auto shape = [&](double r) {
    return superquadric ? RockShape<3>::superquadric(Vec<3>::Constant(r), 2, 2) : RockShape<3>::sphere(r);
  };
  add_rock<3>(*rocks, shape(0.14), 2600, Vec<3>(0.19, 0.21, 0.45), Vec<3>(0.3, 0, -1)).body.set_spin(Vec<3>(1, -2, 3));
  add_rock<3>(*rocks, shape(0.12), 2600, Vec<3>(0.24, 0.2, 0.715), Vec<3>(0, 0, -2));
  put_rocks<3>(*solver, std::move(rocks));
  return solver;
}

}  // namespace

TEST_CASE("a superquadric of exponent 2 and equal half axes falls on soil and on another as a sphere does") {
  auto spheres = falling_rocks(false, true), others = falling_rocks(true, true);
  long touched = 0;
  double apart = 0, turned = 0;
  for (int step = 0; step < 200; ++step) {
    const double dt = spheres->stable_step();
    CHECK(others->stable_step() == Approx(dt).epsilon(1e-9));
    spheres->step(dt);
    others->step(dt);
    touched += spheres->rocks->touching;
    for (std::size_t k = 0; k < 2; ++k) {
      const auto &a = spheres->rocks->all[k].body, &b = others->rocks->all[k].body;
      apart = std::max({apart, (a.centre - b.centre).norm() / 0.14, (a.velocity - b.velocity).norm() / 2});
      turned = std::max(turned, (a.spin() - b.spin()).norm() / 4);
    }
  }
  CHECK(touched > 0);
  CHECK(spheres->rocks->all[0].soil_impulse[2] > spheres->rocks->all[0].body.mass);  // more than stops it
  CHECK(apart < 1e-9);
  CHECK(turned < 1e-9);
}

TEST_CASE("a block on a floor stays where it is, also when it is set down askew") {
  for (const double askew : {0.0, 0.01}) {
    CAPTURE(askew);
    Rocks<3> rocks;
    rocks.materials = {{5e8, 0.2, 0.6, 0.3}};
    const auto shape = RockShape<3>::superquadric(Vec<3>(0.15, 0.1, 0.075), 20, 20);
    auto& block = add_rock<3>(rocks, shape, 2600, Vec<3>(0, 0, 0.075)).body;
    block.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(askew, Vec<3>(1, 2, 0).normalized()));
    block.centre[2] = shape.height(to_body<3>(block.orientation, Vec<3>(0, 0, -1)));
    const std::vector<Wall<3>> floor{wall_at(Vec<3>::Zero(), Vec<3>::UnitZ(), 0.6)};
    const auto walls = [&](double) { return floor; };
    for (int step = 0; step < 2000; ++step) rocks.advance(walls, gravity_down, 0, 1e-3);
    const auto& body = rocks.all[0].body;
    // It turns about its lowest corner.
    CHECK(std::hypot(body.centre[0], body.centre[1]) < 1.1 * askew * 0.075 + 1e-12);
    CHECK(body.centre[2] == Approx(0.075).epsilon(2e-3));
    // Down by its corner, and no further over than it was.
    CHECK((body.orientation * Vec<3>::UnitZ())[2] > std::cos(askew) - 1e-12);
    CHECK(body.velocity.norm() < 1e-3);
    const Vec<3> before = rocks.wall_impulse[0];
    for (int step = 0; step < 500; ++step) rocks.advance(walls, gravity_down, 0, 1e-3);
    CHECK((rocks.wall_impulse[0] - before)[2] / 0.5 == Approx(-9.81 * body.mass).epsilon(2e-3));
  }
}

TEST_CASE("three spheres in a tube of smooth walls come to rest, and the floor carries them") {
  Rocks<3> rocks;
  rocks.materials = {{1e8, 0.25, 0.4, 0.3}};
  for (int k = 0; k < 3; ++k) {
    add_rock<3>(rocks, RockShape<3>::sphere(0.1), 2600,
                Vec<3>(k == 1 ? 0.008 : -0.008, k == 2 ? 0.006 : 0, 0.15 + 0.25 * k));
  }
  std::vector<Wall<3>> tube{wall_at(Vec<3>::Zero(), Vec<3>::UnitZ(), 0.4)};
  for (const int axis : {0, 1}) {
    for (const int side : {-1, 1})
      tube.push_back(wall_at(side * 0.11 * Vec<3>::Unit(axis), -side * Vec<3>::Unit(axis), 0));
  }
  const auto walls = [&](double) { return tube; };
  rocks.first_energy = rocks.energy(gravity_down).residual;
  const double fallen = rocks.energy(gravity_down).potential;
  for (int step = 0; step < 4000; ++step) rocks.advance(walls, gravity_down, 0, 1e-3);
  const auto before = rocks.wall_impulse;
  for (int step = 0; step < 500; ++step) rocks.advance(walls, gravity_down, 0, 1e-3);
  const double weight = 3 * 9.81 * rocks.all[0].body.mass;
  Vec<3> sides = Vec<3>::Zero(), floor = (rocks.wall_impulse[0] - before[0]) / 0.5;
  for (std::size_t k = 1; k < 5; ++k) sides += (rocks.wall_impulse[k] - before[k]) / 0.5;
  CHECK(floor[2] == Approx(-weight).epsilon(1e-3));
  CHECK(sides[2] == 0);
  CHECK((sides + floor).head<2>().norm() < 1e-3 * weight);
  // Turning about their lines of contact nothing holds them.
  for (const auto& rock : rocks.all) CHECK(rock.body.velocity.norm() < 1e-5);
  for (const auto& rock : rocks.all) CHECK(rock.body.spin().norm() < 1);
  CHECK(rocks.energy(gravity_down).springs > 0);
  CHECK(std::abs(rocks.energy(gravity_down).residual) < 1e-2 * fallen);
}

TEST_CASE("held axes and a held rotation stay as they are while rocks and soil push, and their books balance") {
  for (const bool spins : {false, true}) {
    CAPTURE(spins);
    Rocks<3> rocks;
    rocks.materials = {{5e7, 0.2, 0.4, 0.8}};
    auto& anvil =
        add_rock<3>(rocks, RockShape<3>::superquadric(Vec<3>(0.2, 0.15, 0.1), 4, 4), 2600, Vec<3>(0, 0, 0)).body;
    anvil.free = Vec<3>(0, 1, 0);
    anvil.velocity = Vec<3>(0.1, 0, 0);
    anvil.turns = false;
    const Vec<3> spin = spins ? Vec<3>(0.5, -1, 2) : Vec<3>(Vec<3>::Zero());
    anvil.set_spin(spin);
    add_rock<3>(rocks, RockShape<3>::sphere(0.1), 2600, Vec<3>(0.05, 0.08, 0.25), Vec<3>(0, 0, -3));
    rocks.first_energy = rocks.energy(gravity_down).residual;
    const auto none = [](double) { return std::vector<Wall<3>>{}; };
    const double came = rocks.all[1].body.kinetic();
    double time = 0;
    for (int step = 0; step < 200; ++step, time += 1e-3) rocks.advance(none, gravity_down, time, 1e-3);
    const auto& body = rocks.all[0].body;
    CHECK(rocks.all[1].body.velocity[2] > 0);
    CHECK(body.velocity[0] == 0.1);
    CHECK(body.velocity[2] == 0);
    CHECK(body.velocity[1] < 0);  // free, and pushed
    CHECK(body.centre[0] == Approx(0.02).epsilon(1e-12));
    CHECK(body.centre[2] == 0);
    CHECK((body.spin() - spin).norm() <= 1e-13 * spin.norm());
    // About a fixed axis by a fixed rate, however its inertia lies.
    const Eigen::Quaterniond turned(
        Eigen::AngleAxisd(0.2 * spin.norm(), spins ? Vec<3>(spin.normalized()) : Vec<3>::UnitZ()));
    CHECK(body.orientation.angularDistance(turned) < 1e-12);
    if (!spins) CHECK(body.orientation.coeffs() == Eigen::Quaterniond::Identity().coeffs());
    CHECK(std::abs(rocks.energy(gravity_down).residual) < 3e-3 * came);
  }
}

TEST_CASE("a rock that is held along x and in its rotation sinks into soil straight down") {
  for (const bool ghosts : {false, true}) {
    CAPTURE(ghosts);
    auto solver = block<3>({4, 4, 3}, 0.1, ElasticModuli{1e6, 0.3}, 2000);
    enclose<3>(*solver, {4, 4, 12});
    solver->options.gravity = gravity_down;
    auto rocks = std::make_unique<Rocks<3>>();
    rocks->materials = {{1e7, 0.2, 0.3, 0.5}};
    rocks->soil.ghosts = ghosts;
    auto& rock = add_rock<3>(*rocks, RockShape<3>::superquadric(Vec<3>(0.12, 0.1, 0.1), 4, 4), 2600,
                             Vec<3>(0.15, 0.2, 0.41), Vec<3>(0, 0, -1));
    rock.body.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(0.5, Vec<3>(1, 1, 0).normalized()));
    rock.body.centre[2] = 0.45;
    rock.body.free[0] = 0;
    rock.body.turns = false;
    const auto orientation = rock.body.orientation.coeffs();
    put_rocks<3>(*solver, std::move(rocks));
    while (solver->time < 0.05) solver->step(solver->stable_step());
    const auto& body = solver->rocks->all[0].body;
    CHECK(solver->rocks->all[0].soil_impulse[2] > 0);
    CHECK(body.centre[0] == 0.15);
    CHECK(body.velocity[0] == 0);
    CHECK(body.spin() == Vec<3>(Vec<3>::Zero()));
    CHECK((body.orientation.coeffs() - orientation).norm() < 1e-15);
  }
}
