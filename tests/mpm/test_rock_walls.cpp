// Rocks against walls that move or vanish, rocks that turn, and rocks of the plane: energy and momentum.
#include "tests/catch.hpp"
#include "tests/mpm/rocks.hpp"

using namespace mpm;
using namespace mpm::test;

namespace {

const auto far_from_walls = [](double) { return std::vector<Wall<3>>{}; };

}  // namespace

TEST_CASE("a wall that moves throws an elastic sphere off at twice its speed, and its work is the sphere's energy") {
  Rocks<3> rocks;
  rocks.materials = {{1e9, 0.2, 0.5, 1}};
  add_rock<3>(rocks, RockShape<3>::sphere(0.1), 2600, Vec<3>(0.1001, 0, 0));
  const auto walls = [](double time) {
    Wall<3> piston;
    piston.normal = Vec<3>(1, 0, 0);
    piston.velocity = Vec<3>(3, 0, 0);
    piston.point = time * piston.velocity;
    return std::vector<Wall<3>>{piston};
  };
  for (int step = 0; step < 5; ++step) rocks.advance(walls, Vec<3>::Zero(), step * 1e-3, 1e-3);
  const auto& body = rocks.all[0].body;
  CHECK(rocks.touching == 0);
  CHECK(body.velocity[0] == Approx(6).epsilon(1e-3));
  CHECK(rocks.wall_work == Approx(0.5 * body.mass * 36).epsilon(1e-3));
  CHECK(rocks.wall_impulse[0][0] == Approx(-6 * body.mass).epsilon(1e-3));
}

TEST_CASE("a block that turns on the spot hits with the speed of its end: sub-steps are enough for that") {
  Rocks<3> rocks;
  rocks.materials = {{1e10, 0.2, 0, 1}};
  auto& club =
      add_rock<3>(rocks, RockShape<3>::superquadric(Vec<3>(0.3, 0.05, 0.05), 4, 4), 2600, Vec<3>(0, 0, 0)).body;
  club.set_spin(Vec<3>(0, 0, 30));
  add_rock<3>(rocks, RockShape<3>::sphere(0.06), 2600, Vec<3>(0.25, 0.13, 0));
  rocks.first_energy = rocks.energy(Vec<3>::Zero()).residual;
  double worst = 0;
  for (int step = 0; step < 20; ++step) {
    rocks.advance(far_from_walls, Vec<3>::Zero(), 0, 1e-3);
    worst = std::max(worst, std::abs(rocks.energy(Vec<3>::Zero()).residual));
  }
  CHECK(rocks.all[1].body.velocity[1] > 1);
  CHECK(rocks.touching == 0);
  CHECK(worst < 1e-2 * rocks.first_energy);
}

TEST_CASE("discs and ellipses that collide in the plane keep momentum, angular momentum and their books") {
  double worst[2];
  for (const int finer : {1, 2}) {
    Rocks<2> rocks;
    rocks.thickness = 0.5;
    rocks.materials = {{1e7, 0.2, 100, 1}};
    rocks.steps_per_collision = 1e-9;  // one sub-step a step
    add_rock<2>(rocks, RockShape<2>::superquadric(Vec<2>(0.12, 0.08), 2, 2), 2600, Vec<2>(0, 0), Vec<2>(0.4, 0.3));
    add_rock<2>(rocks, RockShape<2>::sphere(0.1), 2600, Vec<2>(0.25, 0.02), Vec<2>(-1, 0.1));
    rocks.all[0].body.orientation = 0.4;
    rocks.all[0].body.set_spin(Spin<2>(4));
    rocks.all[1].body.set_spin(Spin<2>(-3));
    rocks.first_energy = rocks.energy(Vec<2>::Zero()).residual;
    const auto angular = [&] {
      double sum = 0;
      for (const auto& rock : rocks.all)
        sum += rock.body.angular_momentum[0] + rock.body.mass * moment<2>(rock.body.centre, rock.body.velocity)[0];
      return sum;
    };
    const Vec<2> momentum = momentum_of<2>(rocks);
    const double turning = angular();
    worst[finer - 1] = 0;
    bool touched = false;
    for (int step = 0; step < 2000 * finer; ++step) {
      rocks.advance([](double) { return std::vector<Wall<2>>{}; }, Vec<2>::Zero(), 0, 5e-5 / finer);
      touched = touched || rocks.touching > 0;
      worst[finer - 1] = std::max(worst[finer - 1], std::abs(rocks.energy(Vec<2>::Zero()).residual));
    }
    CHECK(touched);
    CHECK(rocks.touching == 0);
    CHECK((momentum_of<2>(rocks) - momentum).norm() < 1e-12 * rocks.all[1].body.mass);
    CHECK(std::abs(angular() - turning) < 1e-12 * rocks.all[1].body.mass * 0.1);
    CHECK(worst[finer - 1] < 1e-3 * rocks.first_energy);
  }
  // Of the first order: the place of a contact moves over an ellipse.
  CHECK(worst[0] > 1.8 * worst[1]);
}

TEST_CASE("a floor that is removed lets a resting sphere fall, and what its springs held is booked as lost") {
  const Vec<3> down(0, 0, -10);
  Rocks<3> rocks;
  rocks.materials = {{1e6, 0.2, 0.5, 0.3}};
  add_rock<3>(rocks, RockShape<3>::sphere(0.1), 2600, Vec<3>(0, 0, 0.1));
  rocks.first_energy = rocks.energy(down).residual;
  const auto walls = [](double time) {
    Wall<3> floor;
    floor.normal = Vec<3>::UnitZ();
    floor.there = time < 1.0003;  // within a step
    return std::vector<Wall<3>>{floor};
  };
  for (int step = 0; step < 1000; ++step) rocks.advance(walls, down, 1e-3 * step, 1e-3);
  const double held = rocks.energy(down).springs, lost = rocks.contact_loss, before = rocks.energy(down).residual;
  const double place = rocks.all[0].body.centre[2];
  for (int step = 0; step < 100; ++step) rocks.advance(walls, down, 1 + 1e-3 * step, 1e-3);
  CHECK(held > 0.01);
  CHECK(rocks.all[0].body.centre[2] == Approx(place - 5 * 0.0997 * 0.0997).epsilon(1e-2));
  CHECK(rocks.contact_loss - lost == Approx(held).epsilon(1e-2));
  CHECK(std::abs(rocks.energy(down).residual - before) < 1e-2 * held);
}
