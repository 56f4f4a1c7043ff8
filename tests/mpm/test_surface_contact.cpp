// Contact at the surface of plates, footings, piles and pipes: stress, outline, when it begins.
#include "tests/catch.hpp"
#include "tests/mpm/blocks.hpp"

using namespace mpm;
using namespace mpm::test;

TEST_CASE("a plate compresses an elastic block evenly, wherever its face lies between the nodes") {
  for (const double shift : {0.0, 0.02, 0.037, 0.05, 0.08}) {
    CAPTURE(shift);
    const ElasticModuli moduli{1e6, 0.3};
    auto solver = block<2>({5, 10}, 0.1, moduli, 2000);
    solver->planes.all = {roller<2>(0, 0, true), roller<2>(0, 5, false)};
    for (auto& point : solver->points) point.position[1] += shift;
    Body<2> plate;
    plate.shape = Box<2>{Vec<2>(1, 0.3)};
    plate.centre = Vec<2>(0.25, 1 + shift + 0.3);
    plate.velocity.times = {0, 0.1};
    plate.velocity.velocities = {Vec<2>(0, 0), Vec<2>(0, -0.002)};
    solver->bodies.all = {half_space({0, shift}, {0, 1}), plate};
    for (auto& body : solver->bodies.all) body.at_surface = true;
    while (solver->time < 0.55) solver->step(solver->stable_step());
    const double strain = -solver->bodies.all[1].velocity.displacement(solver->time)[1];
    const double oedometer = 1e6 * 0.7 / (1.3 * 0.4);
    double mean = 0, most = 0;
    for (const auto& point : solver->points) {
      mean -= point.stress(1, 1) / double(solver->points.size());
      most = std::max(most, std::abs(point.stress(1, 1) / (oedometer * strain) + 1));
    }
    // At nodes alone the mean is 1 % low on a row of nodes, and 22 to 61 % elsewhere.
    CHECK(mean == Approx(oedometer * strain).epsilon(0.04));
    if (shift < 0.08) CHECK(most < 0.1);  // 0.5 where a point reaches the node behind by a twentieth of a cell
  }
}

TEST_CASE("soil in flight meets a surface when it gets there, not when its shape functions do") {
  for (const Shape shape : {Shape::bspline, Shape::gimp, Shape::linear}) {
    for (const double shift : {0.0, 0.03, 0.06}) {  // of the surface between two rows of nodes
      const double gap = 0.09;                      // m, a little less than a cell
      Body<2> disc, lid;
      disc.shape = Disc<2>{0.3};
      disc.centre = Vec<2>(0.4 + gap + 0.3 + shift, 0.2 + shift);
      lid.shape = Box<2>{Vec<2>(1, 0.25)};
      lid.centre = Vec<2>(0.2, 0.4 + gap + 0.25 + shift);
      const struct {
        Body<2> body;
        Vec<2> velocity;
        double soon;  // cells; a disc meets its nearest point between two rows of soil
      } met[] = {{half_space({0, -gap - shift}, {0, 1}), {0, -1}, 0.12}, {lid, {0, 1}, 0.12}, {disc, {1, 0}, 0.2}};
      for (const auto& each : met) {
        auto flying = block<2>({4, 4}, 0.1, ElasticModuli{1e6, 0.3}, 2000);
        flying->options.shape = shape;
        flying->options.scheme = shift == 0.03 ? Scheme::musl : Scheme::usf;
        const double thickness = shift == 0.06 ? 0.01 : 1;
        for (auto& point : flying->points) {
          point.volume *= thickness;
          point.mass *= thickness;
        }
        flying->bodies.shape = shape;
        flying->bodies.all = {each.body};
        flying->bodies.all[0].at_surface = true;
        set_velocity<2>(*flying, [&](const Vec<2>&) { return each.velocity; });
        while (flying->bodies.all[0].reaction.impulse.isZero(0) && flying->time < 1) flying->step(2e-4);
        CAPTURE(int(shape), shift, each.body.shape.index());
        CHECK(flying->time > gap + shift - each.soon * 0.1);
        CHECK(flying->time < gap + shift + 0.2 * 0.1);
      }
    }
  }
}

TEST_CASE("what lies below a footing is not beside it") {
  auto solver = block<2>({8, 4}, 0.1, ElasticModuli{1e6, 0.3}, 2000);
  Body<2> footing;
  footing.shape = Box<2>{Vec<2>(0.2, 0.2)};
  footing.centre = Vec<2>(0.4, 0.6);
  footing.rough = false;
  footing.at_surface = true;
  solver->bodies.all = {footing};
  for (const double speed : {1.0, -1.0}) {
    set_velocity<2>(*solver, [&](const Vec<2>&) { return Vec<2>(speed, 0); });
    for (int k = 0; k < 10; ++k) solver->step(solver->stable_step());
  }
  CHECK(solver->bodies.all[0].reaction.impulse[0] == 0);
  set_velocity<2>(*solver, [&](const Vec<2>&) { return Vec<2>(0, 0.1); });
  for (int k = 0; k < 10; ++k) solver->step(solver->stable_step());
  CHECK(solver->bodies.all[0].reaction.impulse[1] < 0);
}

TEST_CASE("a body narrower than the points are apart is met all the same") {
  for (const double centre : {1.0, 1.06, 1.125}) {  // between two columns of points, and over one
    auto solver = block<2>({4, 2}, 0.5, ElasticModuli{1e6, 0.3}, 2000);
    Body<2> pile;
    pile.shape = Box<2>{Vec<2>(0.05, 1)};
    pile.centre = Vec<2>(centre, 2.01);
    pile.velocity.times = {0};
    pile.velocity.velocities = {Vec<2>(0, -1)};
    pile.at_surface = true;
    solver->bodies.all = {pile};
    while (solver->time < 0.06) solver->step(1e-3);
    CAPTURE(centre);
    CHECK(solver->bodies.all[0].reaction.impulse[1] < 0);
  }
}

TEST_CASE("soil stays outside the outline of a disc that is pushed in, and all reactions are its momentum") {
  auto solver = block<2>({20, 8}, 0.05, ElasticModuli{1e6, 0.3}, 2000);
  solver->planes.all = {roller<2>(0, 0, true), roller<2>(0, 20, false), roller<2>(1, 0, true)};
  constexpr double radius = 0.13;
  Body<2> disc;
  disc.shape = Disc<2>{radius};
  disc.centre = Vec<2>(0.51, 0.4 + radius);
  disc.velocity.times = {0, 0.05};
  disc.velocity.velocities = {Vec<2>(0, 0), Vec<2>(0, -0.4)};
  disc.at_surface = true;
  solver->bodies.all = {disc};
  while (solver->time < 0.25) solver->step(solver->stable_step());
  const Vec<2> centre = disc.centre + disc.velocity.displacement(solver->time);
  double deepest = 1;
  Vec<2> momentum = Vec<2>::Zero(), pushed = solver->bodies.all[0].reaction.impulse;
  for (const auto& plane : solver->planes.all) pushed += plane.reaction.impulse;
  for (const auto& point : solver->points) {
    deepest = std::min(deepest, (point.position - centre).norm() - radius);
    momentum += point.mass * point.velocity;
  }
  CHECK(deepest > -0.3 * 0.05);  // of a cell
  CHECK((pushed - momentum).norm() < 1e-12 * pushed.cwiseAbs().sum() + 1e-10);
  CHECK(solver->bodies.all[0].reaction.impulse[1] < -1);
}

TEST_CASE("in space a plate compresses an elastic block evenly, and a cylinder is met along its axis") {
  const ElasticModuli moduli{1e6, 0.3};
  auto solver = block<3>({3, 3, 4}, 0.1, moduli, 2000);
  for (const int axis : {0, 1}) {
    solver->planes.all.push_back(roller<3>(axis, 0, true));
    solver->planes.all.push_back(roller<3>(axis, 3, false));
  }
  for (auto& point : solver->points) point.position[2] += 0.037;
  Body<3> base, plate;
  base.shape = HalfSpace<3>{Vec<3>(0, 0, 1)};
  base.centre = Vec<3>(0, 0, 0.037);
  base.rough = false;
  plate.shape = Box<3>{Vec<3>(1, 1, 0.3)};
  plate.centre = Vec<3>(0.15, 0.15, 0.4 + 0.037 + 0.3);
  plate.velocity.times = {0, 0.1};
  plate.velocity.velocities = {Vec<3>::Zero(), Vec<3>(0, 0, -0.002)};
  solver->bodies.all = {base, plate};
  for (auto& body : solver->bodies.all) body.at_surface = true;
  while (solver->time < 0.3) solver->step(solver->stable_step());
  const double strain = -solver->bodies.all[1].velocity.displacement(solver->time)[2] / 0.4;
  double mean = 0;
  for (const auto& point : solver->points) mean -= point.stress(2, 2) / double(solver->points.size());
  CHECK(mean == Approx(1e6 * 0.7 / (1.3 * 0.4) * strain).epsilon(0.03));

  // A cylinder along z pushes a block that is free: every layer of it alike.
  auto pushed = block<3>({4, 3, 3}, 0.1, moduli, 2000);
  Body<3> cylinder;
  cylinder.shape = Disc<3>{0.3};
  cylinder.centre = Vec<3>(-0.3, 0.15, 0);
  cylinder.velocity.times = {0};
  cylinder.velocity.velocities = {Vec<3>(0.5, 0, 0)};
  cylinder.at_surface = true;
  pushed->bodies.all = {cylinder};
  for (int k = 0; k < 60; ++k) pushed->step(pushed->stable_step());
  Vec<3> momentum = Vec<3>::Zero();
  for (const auto& point : pushed->points) momentum += point.mass * point.velocity;
  CHECK(momentum[0] > 1);
  CHECK((momentum - pushed->bodies.all[0].reaction.impulse).norm() < 1e-12 * momentum[0]);
  CHECK(std::abs(momentum[1]) < 1e-4 * momentum[0]);  // the order of the sweeps favours no side
  CHECK(std::abs(momentum[2]) < 0.05 * momentum[0]);
}
