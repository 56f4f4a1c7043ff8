// Rocks among themselves and against walls: exact answers.
#include "tests/catch.hpp"
#include "tests/mpm/rocks.hpp"

using namespace mpm;
using namespace mpm::test;

namespace {

const std::vector<Wall<3>> no_walls;
const auto without_walls = [](double) { return no_walls; };

Wall<3> floor_below(double friction) {
  Wall<3> wall;
  wall.normal = Vec<3>(0, 0, 1);
  wall.follows_material = false;
  wall.friction = friction;
  return wall;
}

}  // namespace

TEST_CASE("two elastic spheres meet head on: overlap, duration and speeds by Hertz") {
  // m* x'' = -k x^(3/2), k = 4/3 E* sqrt(r*): delta_max = (5/4 m* v^2/k)^(2/5), duration 2.9432751 delta_max/v.
  const double e_star = 1e9 / (2 * (1 - 0.04)), k = 4.0 / 3 * e_star * std::sqrt(0.01);
  double residual[2];
  for (const int finer : {1, 2}) {
    Rocks<3> rocks;
    rocks.materials = {{1e9, 0.2, 0.8, 1}};
    add_rock<3>(rocks, RockShape<3>::sphere(0.02), 1e4, Vec<3>(0.0205, 0, 0), Vec<3>(-5, 0, 0));
    add_rock<3>(rocks, RockShape<3>::sphere(0.02), 1e4, Vec<3>(-0.0205, 0, 0));
    rocks.first_energy = rocks.energy(Vec<3>::Zero()).residual;
    const double m = 0.5 * rocks.all[0].body.mass, dt = 1e-6 / finer;
    rocks.steps_per_collision = 1e-9;  // one sub-step a step
    double most = 0, begin = 0, end = 0, lost = 0, before = 1e-3;
    for (int step = 0; step < 1200 * finer; ++step) {
      rocks.advance(without_walls, Vec<3>::Zero(), 0, dt);
      const double gap = rocks.all[0].body.centre[0] - rocks.all[1].body.centre[0] - 0.04;
      // The moment of touching lies within a step: by the gaps on both sides.
      if (before >= 0 && gap < 0) begin = (step + before / (before - gap)) * dt;
      if (before < 0 && gap >= 0) end = (step + before / (before - gap)) * dt;
      before = gap;
      most = std::max(most, -gap);
      lost = std::max(lost, std::abs(rocks.energy(Vec<3>::Zero()).residual));
    }
    residual[finer - 1] = lost;
    const double delta = std::pow(1.25 * m * 25 / k, 0.4);
    CHECK(most == Approx(delta).epsilon(1e-4));
    CHECK(end - begin == Approx(2.94327510 * delta / 5).epsilon(1e-4));
    CHECK(rocks.all[0].body.velocity[0] == Approx(0).margin(5e-6));
    CHECK(rocks.all[1].body.velocity[0] == Approx(-5).epsilon(1e-6));
    CHECK(lost < 1e-4 * rocks.all[1].body.kinetic());
  }
  CHECK(residual[0] / residual[1] == Approx(4).epsilon(0.1));
}

TEST_CASE("the coefficient of restitution is that of the material at any speed, in the plane and in space") {
  for (const double e : {0.2, 0.5, 0.9}) {
    for (const double speed : {0.01, 1.0}) {
      Rocks<3> balls;
      balls.materials = {{1e9, 0.2, 0.8, e}};
      balls.steps_per_collision = 2000;
      add_rock<3>(balls, RockShape<3>::sphere(0.02), 2600, Vec<3>(0, 0, 0.0201), Vec<3>(0, 0, -speed));
      const auto walls = [](double) { return std::vector<Wall<3>>{floor_below(0)}; };
      while (balls.all[0].body.velocity[2] < 0 || balls.touching > 0)
        balls.advance(walls, Vec<3>::Zero(), 0, 1e-4 / speed);
      CHECK(balls.all[0].body.velocity[2] == Approx(e * speed).epsilon(2e-3));
      Rocks<2> discs;
      discs.materials = balls.materials;
      discs.steps_per_collision = 2000;
      add_rock<2>(discs, RockShape<2>::sphere(0.02), 2600, Vec<2>(0, 0));
      add_rock<2>(discs, RockShape<2>::sphere(0.03), 2600, Vec<2>(0.0501, 0), Vec<2>(-speed, 0));
      const auto none = [](double) { return std::vector<Wall<2>>{}; };
      double apart = -speed;
      while (apart < 0 || discs.touching > 0) {
        discs.advance(none, Vec<2>::Zero(), 0, 1e-4 / speed);
        apart = discs.all[1].body.velocity[0] - discs.all[0].body.velocity[0];
      }
      CHECK(apart == Approx(e * speed).epsilon(2e-3));
    }
  }
}

TEST_CASE("a sphere rolls down a slope at 5/7 g sin, and slides where friction is too small") {
  const double angle = 30 * pi / 180, g = 9.81, r = 0.05;
  const Vec<3> gravity(g * std::sin(angle), 0, -g * std::cos(angle));
  const struct {
    double friction, speed, spin;  // m/s^2, rad/s^2
  } cases[] = {{0.5, 5.0 / 7 * g * std::sin(angle), 5.0 / 7 * g * std::sin(angle) / r},
               {0.1, g * (std::sin(angle) - 0.1 * std::cos(angle)), 2.5 * 0.1 * g * std::cos(angle) / r}};
  for (const auto& each : cases) {
    Rocks<3> rocks;
    rocks.materials = {{5e7, 0.2, 0.8, 0.5}};
    auto& ball = add_rock<3>(rocks, RockShape<3>::sphere(r), 2600, Vec<3>(0, 0, 0));
    const RockPair<3> pair = rocks.constants_of(0, 1, &static_cast<const Wall<3>&>(floor_below(0)));
    ball.body.centre[2] = r - std::pow(ball.body.mass * -gravity[2] / pair.k, 2.0 / 3);
    const auto walls = [&](double) { return std::vector<Wall<3>>{floor_below(each.friction)}; };
    for (int step = 0; step < 500; ++step) rocks.advance(walls, gravity, 0, 1e-3);
    const auto& body = rocks.all[0].body;
    CHECK(body.velocity[0] == Approx(0.5 * each.speed).epsilon(5e-3));
    CHECK(body.centre[0] == Approx(0.125 * each.speed).epsilon(5e-3));
    CHECK(body.spin()[1] == Approx(0.5 * each.spin).epsilon(5e-3));
  }
}

TEST_CASE("a body that spins freely about its middle axis tumbles, and keeps angular momentum and energy") {
  Rigid<3> body;
  body.mass = 1;
  body.inertia = Vec<3>(1, 2, 3);
  body.set_spin(Vec<3>(1e-3, 1, 1e-3));
  const Vec<3> momentum = body.angular_momentum;
  const double energy = body.kinetic();
  double turned = 1, lost = 0;
  for (int step = 0; step < 100'000; ++step) {
    body.drift(1e-3);
    const Vec<3> about = body.orientation.conjugate() * body.spin();
    turned = std::min(turned, about[1]);
    lost = std::max(lost, std::abs(body.kinetic() / energy - 1));
  }
  CHECK(turned < -0.9);  // the middle axis is no stable one
  CHECK((body.angular_momentum - momentum).norm() < 1e-12 * momentum.norm());
  CHECK(lost < 1e-6);
  CHECK(body.orientation.norm() == Approx(1).epsilon(1e-14));
}
