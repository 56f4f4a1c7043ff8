// Rigid bodies (clumps) in the cell: laws of nature, a clump of one, frames, copies of the cell, bits.
#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <tuple>

#include "rvelab/cell/cell.hpp"
#include "rvelab/error.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/measure/tangent.hpp"
#include "rvelab/specimen/clumps.hpp"
#include "rvelab/specimen/specimen_check.hpp"
#include "tests/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

Turn drawn_turn(int dimension, std::mt19937_64& generator) {
  const auto uniform = [&] { return 2 * double(generator() >> 11) / 9007199254740992.0 - 1; };
  if (dimension == 2) return normalised(Turn{uniform(), {0, 0, uniform()}});
  return normalised(Turn{uniform(), {uniform(), uniform(), uniform()}});
}

/// Clumps at the sites of a crystal, turned anyhow, that overlap somewhat: brought to rest.
Specimen clumps_in_a_crystal(Shape shape, int side, const char* name, double radius_over_spacing, std::uint64_t seed,
                             Law law = Law::linear_stiffness) {
  const int d = dimension_of(shape);
  const double spacing = 0.01;
  Material m = linear_material(1e6, 5e5, 0.5);
  m.young_modulus = 1e8;
  m.poisson_ratio = 0.2;
  Specimen s = empty_specimen(shape, side * spacing, m, law);
  if (d == 2) s.cell.lattice(2, 2) = spacing;
  s.solver.max_overlap_ratio = 0.8;
  std::mt19937_64 generator(seed);
  const Clump clump = published_clump(name, d);
  for (int k = 0; k < (d == 2 ? 1 : side); ++k)
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i) {
        Vector3 x = Vector3(i, j, k) * spacing - 0.5 * (side - 1) * spacing * Vector3::Ones();
        if (d == 2) x[2] = 0;
        add_clump(s, clump, radius_over_spacing * spacing, x, drawn_turn(d, generator));
      }
  return s;
}

Specimen pressed_clumps(Shape shape, int side, const char* name, std::uint64_t seed, Law law = Law::linear_stiffness) {
  Rve rve(clumps_in_a_crystal(shape, side, name, 0.5, seed, law));
  rve.relax(1e-4, 20'000);
  for (int round = 0; round < 60 && mean_pressure(rve.stress(), rve.cell().dimension) < 5e3; ++round) {
    Matrix3 gradient = Matrix3::Zero();
    for (int k = 0; k < rve.cell().dimension; ++k) gradient(k, k) = -5e-3;
    rve.apply(gradient, 0);
    rve.relax(1e-4, 5'000);
  }
  rve.relax(1e-6, 50'000);
  return rve.specimen();
}

Matrix3 sheared(double xx, double yy, double xy) {
  Matrix3 gradient = Matrix3::Zero();
  gradient(0, 0) = xx;
  gradient(1, 1) = yy;
  gradient(0, 1) = xy;
  return gradient;
}

Vector3 angular_momentum(const Specimen& s) {
  Vector3 sum = Vector3::Zero();
  for (const Body& body : s.bodies) {
    const double mass = s.materials[0].density * body.volume;
    const Matrix3 axes = axes_of(body.orientation);
    sum += mass * body.position.cross(body.velocity) +
           mass * (axes * body.gyration.asDiagonal() * axes.transpose()) * body.spin;
  }
  return sum;
}

double kinetic_energy_of(const Specimen& s) {
  double sum = 0;
  for (const Body& body : s.bodies) {
    const double mass = s.materials[0].density * body.volume;
    const Vector3 w = axes_of(body.orientation).transpose() * body.spin;
    sum += 0.5 * mass * (body.velocity.squaredNorm() + w.dot(body.gyration.asDiagonal() * w));
  }
  return sum;
}

/// Two clumps that fly at each other off centre and turn.
Specimen two_clumps(Shape shape, const char* name, Law law, double friction) {
  Material m = linear_material(1e6, 5e5, friction);
  m.young_modulus = 1e8;
  m.poisson_ratio = 0.2;
  Specimen s = empty_specimen(shape, 0.2, m, law);
  const int d = dimension_of(shape);
  const Clump clump = published_clump(name, d);
  std::mt19937_64 generator(7);
  add_clump(s, clump, 0.01, {-0.02, 0.003, 0}, drawn_turn(d, generator));
  add_clump(s, clump, 0.012, {0.02, -0.004, 0}, drawn_turn(d, generator));
  const double ratio = s.bodies[0].volume / s.bodies[1].volume;
  s.bodies[0].velocity = {1, 0.1, 0};
  s.bodies[1].velocity = -ratio * s.bodies[0].velocity;
  s.bodies[0].spin = d == 2 ? Vector3(0, 0, 20) : Vector3(10, -15, 20);
  s.state.last_step.loading = Loading::at_rate;
  return s;
}

}  // namespace

TEST_CASE("Clumps that meet keep momentum, angular momentum and energy") {
  // Without friction the energy too: what tangential springs hold ends as the contact opens.
  for (const auto& [shape, law, friction] : {std::tuple{Shape::sphere, Law::linear_stiffness, 0.5},
                                             {Shape::sphere, Law::linear_stiffness, 0.0},
                                             {Shape::sphere, Law::hertz_mindlin, 0.0},
                                             {Shape::disc, Law::linear_stiffness, 0.5},
                                             {Shape::disc, Law::linear_stiffness, 0.0}}) {
    Specimen s = two_clumps(shape, shape == Shape::disc ? "triangle" : "square", law, friction);
    s.solver.fixed_time_step = 2e-7;
    Rve rve(s);
    const Vector3 spun = angular_momentum(s);
    const double energy = kinetic_energy_of(s);
    bool touched = false;
    double error = 0;
    for (int k = 0; k < 50; ++k) {
      rve.apply(Matrix3::Zero(), 1e-3);
      const Specimen now = rve.specimen();
      touched = touched || !rve.network().contacts.empty() || now.bodies[0].velocity[0] < 0.5;
      Vector3 momentum = Vector3::Zero();
      for (const Body& body : now.bodies) momentum += body.volume * body.velocity;
      CHECK(momentum.norm() < 1e-12 * now.bodies[0].volume);
      error = std::max(error, (angular_momentum(now) - spun).norm() / spun.norm());
    }
    CAPTURE(int(shape), int(law), touched, error);
    CHECK(touched);
    CHECK(rve.network().contacts.empty());
    CHECK(error < 1e-10);
    const double change = kinetic_energy_of(rve.specimen()) / energy - 1;
    CAPTURE(change);
    CHECK(change < 2e-4);
    if (friction == 0) CHECK(change > -2e-4);
  }
}

TEST_CASE("A clump in flight turns as a free top") {
  Specimen s = empty_specimen(Shape::sphere, 0.2, linear_material(1e6, 5e5, 0.5));
  add_clump(s, clump_of("top", {{{0, 0, 0}, 1}, {{0.9, 0.3, 0}, 0.7}, {{-0.2, 0.8, 0.5}, 0.6}}, 3), 0.01,
            {0.01, 0.02, -0.03}, cayley_turn({0.3, -0.8, 0.4}));
  s.bodies[0].spin = {300, 200, -100};
  s.state.last_step.loading = Loading::at_rate;
  s.solver.fixed_time_step = 1e-5;
  const Vector3 spun = angular_momentum(s);
  const double energy = kinetic_energy_of(s);
  Rve rve(s);
  Vector3 moments = s.bodies[0].gyration,
          momentum = moments.cwiseProduct(axes_of(s.bodies[0].orientation).transpose() * s.bodies[0].spin);
  Turn q = s.bodies[0].orientation;
  for (int k = 0; k < 100; ++k) rve.apply(Matrix3::Zero(), 1e-3);
  for (int k = 0; k < 100'000; ++k) rotate_freely(1e-6, moments, momentum, q);  // ten times as fine
  const Body& body = rve.specimen().bodies[0];
  CHECK((angular_momentum(rve.specimen()) - spun).norm() < 1e-10 * spun.norm());
  CHECK(std::abs(kinetic_energy_of(rve.specimen()) / energy - 1) < 1e-10);
  CHECK((axes_of(rve.specimen().bodies[0].orientation) - axes_of(q)).norm() < 1e-3);
  CHECK(body.volume > 0);
  check_specimen(rve.specimen());  // members stand where their body says
}

TEST_CASE("A clump of one is the sphere: the same path to 1e-10 of the pressure") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    const Specimen spheres = [&] {
      Rve rve(disordered(shape, shape == Shape::disc ? 12 : 6, linear_material(1e6, 5e5, 0.5), Law::linear_stiffness,
                         0.52, 3));
      rve.relax(1e-6, 50'000);
      return rve.specimen();
    }();
    Specimen alone = spheres, clumps = spheres;
    alone.state = clumps.state = SolverState{};
    alone.solver.fixed_substeps = clumps.solver.fixed_substeps = 50;
    const Clump single = published_clump("single", dimension_of(shape));
    clumps.grains = Grains{};
    for (std::size_t g = 0; g < spheres.grains.size(); ++g)
      add_clump(clumps, single, spheres.grains.radius[g], spheres.grains.position[g], Turn{});
    clumps.grains.id = spheres.grains.id;
    for (auto* s : {&alone, &clumps})
      for (auto* v : {&s->grains.velocity, &s->grains.spin}) std::fill(v->begin(), v->end(), Vector3::Zero());
    Rve a(alone), b(clumps);
    const double pressure = mean_pressure(a.stress(), a.cell().dimension);
    for (int k = 0; k < 4; ++k) {
      a.apply(sheared(-5e-5, 2e-5, 3e-5), 0);
      b.apply(sheared(-5e-5, 2e-5, 3e-5), 0);
      CAPTURE(int(shape), k, a.stress() - b.stress(), pressure);
      CHECK((a.stress() - b.stress()).norm() < 1e-10 * pressure);
    }
    CHECK(std::abs(void_ratio(a.network()) - void_ratio(b.network())) < 1e-12);
    CHECK(coordination_number(a.network()) == coordination_number(b.network()));
  }
}

TEST_CASE("Clumps bear stress in balance; sums, network and records agree") {
  for (const auto& [shape, name] : {std::pair{Shape::disc, "triangle"}, {Shape::sphere, "tetrapod"}}) {
    const Specimen packed = pressed_clumps(shape, shape == Shape::disc ? 8 : 4, name, 11);
    Rve rve(packed);
    const int d = rve.cell().dimension;
    const double pressure = mean_pressure(rve.stress(), d);
    CAPTURE(name, pressure, rve.unbalanced_ratio());
    CHECK(pressure > 1e3);
    CHECK(rve.unbalanced_ratio() < 1e-5);
    const Network network = rve.network();
    CHECK(network.grains.size() == packed.bodies.size());
    CHECK((contact_stress(network) - rve.contact_stress()).norm() < 1e-12 * pressure);
    // In balance of forces and moments the stress is symmetric; that of the members' branches is not the same.
    CHECK((rve.stress() - rve.stress().transpose()).norm() < 1e-3 * pressure);
    CHECK(unbalanced_force_ratio(network) < 1e-4);
    CHECK(unbalanced_torque_ratio(network) < 1e-4);
    double solid = 0;
    for (const Body& body : packed.bodies) solid += body.volume;
    CHECK(std::abs(void_ratio(network) - (rve.cell().volume() - solid) / solid) < 1e-10);
    // Large shear: wrapped and reduced cells, members on other sides of the boundary than their centre.
    for (int k = 0; k < 4; ++k) rve.apply(sheared(0, 0, 0.15), 0);
    check_specimen(rve.specimen());
    CHECK((contact_stress(rve.network()) - rve.contact_stress()).norm() < 1e-10 * pressure);
    CHECK(std::abs(orientation_fabric(rve.network()).trace() - 1) < 1e-12);
  }
}

TEST_CASE("A rigid rotation leaves clumps as they were") {
  Rve rve(pressed_clumps(Shape::sphere, 3, "pair", 5));
  const Matrix3 before = rve.stress();
  const Matrix3 turn = Eigen::AngleAxisd(0.7, Vector3(1, -2, 0.5).normalized()).toRotationMatrix();
  rve.apply(turn - Matrix3::Identity(), 0);
  CHECK((rve.stress() - turn * before * turn.transpose()).norm() < 1e-12 * before.norm());
}

TEST_CASE("Eight copies of a cell of clumps are that cell") {
  const Specimen one = pressed_clumps(Shape::sphere, 3, "triangle", 9);
  Specimen eight = one;
  eight.grains = Grains{};
  eight.bodies.clear();
  eight.members.clear();
  eight.contacts.clear();
  eight.state = SolverState{};
  eight.cell.lattice = 2 * one.cell.lattice;
  for (int copy = 0; copy < 8; ++copy) {
    const Vector3 shift = one.cell.lattice * Vector3(copy % 2 - 0.5, copy / 2 % 2 - 0.5, copy / 4 - 0.5);
    for (std::size_t g = 0; g < one.grains.size(); ++g)
      add_grain(eight, one.grains.position[g] + shift, one.grains.radius[g]);
    for (Body body : one.bodies) {
      body.first += std::int32_t(std::size_t(copy) * one.grains.size());
      body.id = eight.bodies.empty() ? 0 : eight.bodies.back().id + 1;
      body.position += shift;
      body.velocity = body.spin = Vector3::Zero();
      eight.bodies.push_back(body);
    }
    eight.members.insert(eight.members.end(), one.members.begin(), one.members.end());
  }
  Specimen alone = one;
  alone.contacts.clear();
  alone.state = SolverState{};
  for (Body& body : alone.bodies) body.velocity = body.spin = Vector3::Zero();
  for (auto* v : {&alone.grains.velocity, &alone.grains.spin}) std::fill(v->begin(), v->end(), Vector3::Zero());
  alone.solver.fixed_substeps = eight.solver.fixed_substeps = 50;
  Rve a(alone), b(eight);
  const double pressure = mean_pressure(a.stress(), 3);
  CHECK((a.stress() - b.stress()).norm() < 1e-10 * pressure);
  for (int k = 0; k < 3; ++k) {
    a.apply(sheared(-5e-5, 2e-5, 3e-5), 0);
    b.apply(sheared(-5e-5, 2e-5, 3e-5), 0);
    CHECK((a.stress() - b.stress()).norm() < 1e-8 * pressure);
  }
}

TEST_CASE("Clumps go on with the same bits after a snapshot, a reverted trial and a release") {
  for (const double dt : {0.0, 1e-4}) {
    Rve rve(pressed_clumps(Shape::sphere, 3, "tetrapod", 4));
    rve.apply(sheared(-1e-3, 5e-4, 2e-3), dt);
    Rve other(rve.specimen());
    Rve restored(disordered(Shape::sphere, 3, linear_material(1e6, 5e5, 0.5), Law::linear_stiffness, 0.4, 1));
    restored.restore(rve.save());
    rve.attempt(sheared(2e-3, -1e-3, 0), dt);
    rve.revert();
    CHECK(rve.save() == other.save());
    rve.release();
    for (int k = 0; k < 3; ++k)
      for (Rve* each : {&rve, &other, &restored}) each->apply(sheared(-1e-3, 5e-4, 0.05), dt);
    CHECK(rve.save() == other.save());
    CHECK(rve.save() == restored.save());
  }
}

TEST_CASE("The elastic tangent of clumps is what a small increment without slip answers") {
  Specimen s = pressed_clumps(Shape::sphere, 3, "pair", 21);
  s.materials[0].friction = 1e6;
  s.solver.target_unbalanced = 1e-9;
  Rve rve(s);
  rve.relax(1e-9, 200'000);
  const Eigen::MatrixXd tangent = elastic_tangent(rve.network());
  const double strain = 1e-6;
  Rve pressed = rve;
  const Matrix3 before = rve.stress();
  pressed.apply(sheared(-strain, 0, 0), 0);
  pressed.relax(1e-9, 200'000);
  const double measured = (before(0, 0) - pressed.stress()(0, 0)) / strain;
  CAPTURE(measured, tangent(0, 0));
  CHECK(std::abs(measured / tangent(0, 0) - 1) < 0.01);
}

TEST_CASE("What clumps cannot do is refused") {
  Specimen s = clumps_in_a_crystal(Shape::sphere, 2, "pair", 0.3, 1);
  Specimen moved = s;
  moved.grains.position[3][0] += 1e-3;
  CHECK_THROWS_AS(Rve(moved), InputError);
  Specimen longer = s;
  longer.bodies[1].orientation.w *= 1.1;
  CHECK_THROWS_AS(Rve(longer), InputError);
  Specimen gap = s;
  gap.bodies[2].first = gap.bodies[1].first;
  CHECK_THROWS_AS(Rve(gap), InputError);
  Rve rve(s);
  const std::vector<Vector3> none(rve.size(), Vector3::Zero());
  CHECK_THROWS_AS(rve.set_velocities(none, none), InputError);
  CHECK_THROWS_AS(clump_of("apart", {{{0, 0, 0}, 1}, {{3, 0, 0}, 1}}, 3), InputError);
  CHECK_THROWS_AS(clump_of("none", {}, 3), InputError);
  CHECK_THROWS_AS(clump_of("deep", {{{0, 0, 1}, 1}}, 2), InputError);
  CHECK_THROWS_AS(published_clump("tetrapod", 2), InputError);
  CHECK_THROWS_AS(read_members("x,y,q\n0,0,1\n", "shape.csv"), InputError);
  CHECK(read_members("x,y,r\n0,0,1\n0.5,0,1\n", "shape.csv").size() == 2);
}
