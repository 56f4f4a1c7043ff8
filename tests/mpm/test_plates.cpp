// Plates under pressure against mechanics: falling, at rest, on an elastic block, in collisions with soil.
#include <random>

#include "tests/catch.hpp"
#include "tests/mpm/plates.hpp"

using namespace mpm;
using namespace mpm::test;

namespace {

template <int D>
double mass_of(const Solver<D>& solver) {
  double sum = 0;
  for (const auto& point : solver.points) sum += point.mass;
  return sum;
}

/// A column of soil 0.25 m wide and 1 m high between smooth walls under a plate.
std::unique_ptr<Solver<2>> pressed_column(double pressure, double mass_ratio) {
  auto solver = block<2>({2, 8}, 0.125, soil, 2000);
  solver->planes.all = {roller<2>(0, 0, true), roller<2>(0, 2, false), roller<2>(1, 0, true)};
  solver->bodies.all = {plate_over<2>(1, 1, pressure, mass_ratio * mass_of(*solver), 0.25)};
  return solver;
}

/// Soil under the same pressure from rollers and plates, one of each along every axis; `trim`: cells taken off the
/// upper ends.
template <int D>
void expect_rest(Scheme scheme, Shape shape, double trim) {
  constexpr double p = 2e4, cell = 0.1, length = 0.4;
  std::array<int, D> cells;
  cells.fill(4);
  auto solver = block<D>(cells, cell, soil, 2000);
  const double side = length - trim * cell, mass = mass_of(*solver) / 4;
  std::erase_if(solver->points, [&](const auto& point) { return point.position.maxCoeff() > side; });
  solver->groups[0].count = long(solver->points.size());
  for (auto& point : solver->points) {
    point.stress = -p * Mat<D>::Identity();
    point.stress_zz = D == 2 ? -p : 0;
  }
  solver->options.scheme = scheme;
  solver->options.shape = solver->bodies.shape = shape;
  for (int axis = 0; axis < D; ++axis) {
    solver->planes.all.push_back(roller<D>(axis, 0, true));
    solver->bodies.all.push_back(plate_over<D>(axis, side, p, mass, std::pow(side, D - 1)));
  }
  for (int step = 0; step < 100; ++step) solver->step(solver->stable_step());
  const double wave = std::sqrt(soil.wave() / 2000), force = p * std::pow(side, D - 1);
  double fastest = 0, changed = 0;
  for (const auto& point : solver->points) {
    fastest = std::max(fastest, point.velocity.norm());
    changed = std::max(changed, (point.stress + p * Mat<D>::Identity()).norm());
  }
  CAPTURE(D, int(scheme), int(shape), trim);
  CHECK(fastest < 1e-10 * wave);
  CHECK(changed < 1e-8 * p);
  for (int axis = 0; axis < D; ++axis) {
    const auto& body = solver->bodies.all[std::size_t(axis)];
    CHECK(std::abs(body.plate->velocity) < 1e-10 * wave);
    CHECK((body.reaction.impulse / solver->time + force * Vec<D>::Unit(axis)).norm() < 1e-9 * force);
    const Vec<D> held = solver->planes.all[std::size_t(axis)].reaction.impulse / solver->time;
    CHECK((held - force * Vec<D>::Unit(axis)).norm() < 1e-9 * force);
  }
}

/// A block, and perhaps a rock on it, that fly into a plate, which comes to meet them, with nothing else in space.
template <int D>
void expect_momentum(Scheme scheme, double pressure, bool with_rock) {
  std::array<int, D> cells;
  cells.fill(3);
  auto solver = block<D>(cells, 0.1, soil, 2000);
  const double mass = 0.4 * mass_of(*solver), area = std::pow(0.3, D - 1), height = with_rock ? 0.52 : 0.32;
  const Vec<D> up = Vec<D>::Unit(D - 1);
  solver->options.scheme = scheme;
  set_velocity<D>(*solver, [&](const Vec<D>&) { return Vec<D>(2 * up + 0.3 * Vec<D>::Unit(0)); });
  solver->bodies.all = {plate_over<D>(D - 1, height, pressure, mass, area)};
  auto& body = solver->bodies.all[0];
  body.plate->velocity = 1;
  auto rocks = std::make_unique<Rocks<D>>();
  rocks->materials = {{1e7, 0.25, 0.4, 0.5}};
  if (with_rock) {
    add_rock<D>(*rocks, RockShape<D>::sphere(0.09), 2600, Vec<D>::Constant(0.14) + 0.26 * up, 2 * up);
    rocks->prepare_walls(solver->bodies);
    put_rocks<D>(*solver, std::move(rocks));
  }
  const auto total = [&] {
    Vec<D> sum = momentum_of<D>(*solver) - mass * body.plate->velocity * up;
    if (with_rock) sum += momentum_of<D>(*solver->rocks);
    return sum;
  };
  const Vec<D> before = total();
  CAPTURE(D, int(scheme), pressure, with_rock);
  double off = 0;
  for (int step = 0; step < 300; ++step) {
    solver->step(solver->stable_step());
    off = std::max(off, (total() - before + pressure * area * solver->time * up).norm());
  }
  CHECK(off < 1e-12 * before.norm());
  if (with_rock) {
    CHECK(solver->rocks->wall_impulse[0][D - 1] > 0.5 * mass);
    CHECK(solver->rocks->all[0].soil_impulse[D - 1] > 0.5 * mass);
  } else {
    CHECK(body.reaction.impulse[D - 1] < -mass);  // they have met, and parted but for the pressure
    if (pressure == 0) CHECK(momentum_of<D>(*solver)[D - 1] / mass_of(*solver) < -body.plate->velocity);
    const Vec<D> soil_before = before + mass * up;
    CHECK((momentum_of<D>(*solver) - soil_before - body.reaction.impulse).norm() < 1e-12 * before.norm());
  }
}

}  // namespace

TEST_CASE("a plate's velocity is the root of its momentum balance, whatever the soil under it does") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> even(-1, 1);
  int touched = 0;
  for (int set = 0; set < 300; ++set) {
    const double mass = std::pow(10.0, 3 * even(random)), free = even(random);
    std::vector<SurfaceMobility> points(std::size_t(set % 40));
    for (auto& point : points) point = {even(random), std::pow(10.0, 2 * even(random))};
    const auto excess = [&](double v) {
      double sum = mass * (v - free);
      for (const auto& point : points) sum += std::max(0.0, v - point.speed) / point.mobility;
      return sum;
    };
    double low = -1, high = free;  // no soil is slower than -1
    for (int halving = 0; halving < 200; ++halving) {
      const double middle = 0.5 * (low + high);
      (excess(middle) > 0 ? high : low) = middle;
    }
    const double v = plate_velocity(mass, free, points);
    CAPTURE(set, mass, free);
    CHECK(std::abs(v - high) < 1e-12);
    double impulse = 0, most = mass;  // kg: what rounding of v is multiplied by
    for (const auto& point : points) {
      impulse += std::max(0.0, v - point.speed) / point.mobility;
      most += 1 / point.mobility;
    }
    CHECK(std::abs(mass * (free - v) - impulse) <= 1e-14 * most);
    touched += impulse > 0;
  }
  CHECK(touched > 200);
  CHECK(plate_velocity(3, 0.7, {}) == Approx(0.7).epsilon(1e-15));
  CHECK(plate_velocity(3, 0.7, {{0.7, 1}, {2, 1}}) == Approx(0.7).epsilon(1e-15));  // soil that moves away
}

TEST_CASE("a plate with nothing under it is accelerated by its pressure on the area between its sides") {
  Solver<2> solver(1);
  solver.grid.cell = Vec<2>(0.1, 0.2);
  solver.planes.all = {roller<2>(0, 1, true), roller<2>(1, 0, true)};
  solver.bodies.all = {plate_over<2>(1, 5, 300, 20, 0), plate_over<2>(0, 4.1, 50, 10, 0)};
  auto &top = solver.bodies.all[0], &right = solver.bodies.all[1];
  for (auto* body : {&top, &right}) body->plate->thickness = 2;
  top.plate->sides = {{false, 0}, {true, 1}};  // 4 m apart at the start, then less
  right.plate->area = 6;
  const auto run = [&](int steps) {
    for (int step = 0; step < steps; ++step) {
      const double between = 4 - right.plate->displacement;
      solver.step(1e-3);
      CHECK(std::abs(top.plate->area - 2 * between) < 1e-14 * 8);
    }
  };
  run(400);
  const double a = 50 * 6 / 10.0, t = solver.time;
  CHECK(right.plate->velocity == Approx(a * t).epsilon(1e-12));
  CHECK(right.plate->displacement == Approx(0.5 * a * t * t).epsilon(1e-12));
  CHECK((right.displacement_at(t) + right.plate->displacement * Vec<2>::UnitX()).norm() < 1e-15);
  CHECK((right.velocity_at(t) + right.plate->velocity * Vec<2>::UnitX()).norm() < 1e-15);
  CHECK(right.reaction.impulse.norm() == 0);
  // 300 Pa * 2 m * (4 - a t^2/2)/20 kg over time, to the half step by which the area is behind.
  CHECK(top.plate->velocity == Approx(30 * (4 * t - a * t * t * t / 6)).epsilon(1e-3));
  // The sides meet in 0.52 s.
  CHECK_THROWS_WITH(run(200), Catch::Matchers::Contains("have met along x; make the pressures or the loading smaller"));
}

TEST_CASE("the pressure of a plate follows its history") {
  Solver<3> solver(1);
  solver.bodies.all = {plate_over<3>(2, 1, 0, 5, 0.5)};
  auto& plate = *solver.bodies.all[0].plate;
  plate.pressure = {{0, 0.1, 0.3}, {0, 1000, 200}};
  for (int step = 0; step < 100; ++step) solver.step(1e-3);
  CHECK(plate.velocity == Approx(0.5 * 0.5 * 1000 * 0.1 / 5).epsilon(1e-10));
  for (int step = 0; step < 300; ++step) solver.step(1e-3);
  CHECK(plate.velocity == Approx(0.5 / 5 * (50 + 600 * 0.2 + 200 * 0.1)).epsilon(1e-10));
}

TEST_CASE("soil in balance with plates and rollers stays at rest and pushes them with its pressure") {
  for (const Scheme scheme : {Scheme::usf, Scheme::musl}) {
    expect_rest<2>(scheme, Shape::bspline, 0);
    expect_rest<2>(scheme, Shape::bspline, 0.5);
    expect_rest<2>(scheme, Shape::gimp, 0.5);
    expect_rest<3>(scheme, Shape::bspline, 0.5);
  }
}

TEST_CASE("a plate settles on elastic soil by p h/M as its pressure rises to p") {
  const double p = 1e-4 * soil.wave(), crossing = 1 / std::sqrt(soil.wave() / 2000);
  for (const double mass_ratio : {0.02, 0.5}) {  // lighter than a row of nodes, and heavier
    for (const Scheme scheme : {Scheme::usf, Scheme::musl}) {
      CAPTURE(mass_ratio, int(scheme));
      auto solver = pressed_column(p, mass_ratio);
      solver->options.scheme = scheme;
      solver->bodies.all[0].plate->pressure = {{0, 200 * crossing}, {0, p}};
      double mean = 0, samples = 0;
      while (solver->time < 240 * crossing) {
        solver->step(solver->stable_step());
        if (solver->time < 200 * crossing) continue;
        mean += solver->bodies.all[0].plate->displacement;
        ++samples;
      }
      CHECK(mean / samples == Approx(1e-4).epsilon(0.01));
      for (const auto& point : solver->points) CHECK(point.stress(1, 1) == Approx(-p).epsilon(0.03));
    }
  }
}

TEST_CASE("a heavy plate swings on elastic soil with the period of its mass on that spring, and its energy is kept") {
  constexpr double ratio = 30;
  const double p = 1e-4 * soil.wave(), wave = std::sqrt(soil.wave() / 2000);
  auto solver = pressed_column(p, ratio);
  solver->options.pic_fraction = 0;
  solver->options.cfl = 0.2;
  const auto start = energy_start<2>(*solver);
  const auto& body = solver->bodies.all[0];
  const double mass = body.plate->mass;
  std::vector<double> turns;
  double most = 0, unbooked = 0, residual = 0;
  while (turns.size() < 4) {
    const double before = body.plate->velocity, dt = solver->stable_step();
    solver->step(dt);
    const double now = body.plate->velocity, d = body.plate->displacement;
    if (before * now < 0) turns.push_back(solver->time - dt * now / (now - before));
    most = std::max(most, d);
    unbooked = std::max(unbooked, std::abs(p * 0.25 * d - 0.5 * mass * now * now - body.reaction.work));
    residual = std::max(residual, std::abs(energy_balance<2>(*solver, start).residual));
    REQUIRE(solver->time < 1000 / wave);
  }
  // A rod with a mass M on its end: w tan w = m/M, w = omega h/c; for m << M that is omega^2 = E A/(M h).
  double low = 0, high = pi / 2 - 1e-9;
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (low + high);
    (middle * std::tan(middle) > 1 / ratio ? high : low) = middle;
  }
  CHECK(2 * pi * std::sqrt(mass / (soil.wave() * 0.25)) == Approx(2 * pi / (low * wave)).epsilon(0.01));
  CHECK(turns[3] - turns[1] == Approx(2 * pi / (low * wave)).epsilon(0.005));
  CHECK(most == Approx(2e-4).epsilon(0.01));
  CHECK(unbooked < 2e-3 * p * 0.25 * most);
  CHECK(residual < 2e-3 * p * 0.25 * most);
}

TEST_CASE("soil, a rock and a plate that meet keep their momentum but for that of the pressure") {
  for (const Scheme scheme : {Scheme::usf, Scheme::musl}) {
    for (const double pressure : {0.0, 1e4}) {
      for (const bool with_rock : {false, true}) {
        expect_momentum<2>(scheme, pressure, with_rock);
        expect_momentum<3>(scheme, pressure, with_rock);
      }
    }
  }
}

TEST_CASE("soil that slides along a rough plate is slowed by the friction of its pressure") {
  for (const double mu : {0.1, 0.4}) {
    constexpr double p = 1e4;
    auto solver = block<2>({6, 3}, 0.1, soil, 2000);
    solver->planes.all = {roller<2>(1, 0, true)};
    solver->bodies.all = {plate_over<2>(1, 0.3, p, mass_of(*solver), 0.6)};
    solver->bodies.all[0].friction = mu;
    for (auto& point : solver->points) {
      point.velocity = Vec<2>(3, 0);
      point.stress(1, 1) = -p;
      point.stress_zz = -0.25 * p;
    }
    const double before = momentum_of<2>(*solver)[0];
    while (solver->time < 0.1) solver->step(solver->stable_step());
    CAPTURE(mu);
    const double lost = mu * p * 0.6 * solver->time;
    CHECK(before - momentum_of<2>(*solver)[0] == Approx(lost).epsilon(0.01));
    CHECK(-solver->bodies.all[0].reaction.impulse[0] == Approx(lost).epsilon(0.01));
    CHECK(-solver->bodies.all[0].reaction.impulse[1] == Approx(p * 0.6 * solver->time).epsilon(0.01));
  }
}

TEST_CASE("plates that consolidate soil under GIMP stay on it: its volume by the plates is that by the points") {
  constexpr double cell = 0.1, side = 0.4, p = 2e5;
  auto solver = block<3>({4, 4, 4}, cell, ElasticModuli{3e6, 0.3}, 1811);
  solver->options.shape = solver->bodies.shape = Shape::gimp;
  solver->options.pic_fraction = 0.1;
  solver->options.cfl = 0.3;
  for (auto& point : solver->points) point.stress = -0.25 * p * Mat<3>::Identity();
  for (int axis = 0; axis < 3; ++axis) {
    solver->planes.all.push_back(roller<3>(axis, 0, true));
    auto plate = plate_over<3>(axis, side, p, 1811 * cell * side * side, side * side);
    plate.plate->pressure = {{0, 0.1}, {0.25 * p, p}};
    solver->bodies.all.push_back(plate);
  }
  // Between rows of nodes, where B-splines let plates and soil creep apart by 3 % of volume in the second half.
  for (const double until : {0.15, 0.4}) {
    while (solver->time < until) solver->step(solver->stable_step());
    double points = 0, plates = 1;
    for (const auto& point : solver->points) points += point.volume;
    for (int axis = 0; axis < 3; ++axis) plates *= side - solver->bodies.all[std::size_t(axis)].plate->displacement;
    CHECK(points < 0.96 * side * side * side);
    CHECK(plates == Approx(points).epsilon(0.01));
  }
}
