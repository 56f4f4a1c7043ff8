// Rigid bodies (clumps) in the cell: laws of nature, a clump of one, frames, copies of the cell, bits.
#include <cmath>
#include <tuple>

#include "rvelab/error.hpp"
#include "rvelab/specimen/specimen_check.hpp"
#include "tests/bodies.hpp"

using namespace rvelab;
using namespace rvelab::test;

TEST_CASE("Clumps that meet keep momentum, angular momentum and energy") {
  for (const auto& [shape, law, friction] : {std::tuple{Shape::sphere, Law::linear_stiffness, 0.5},
                                             {Shape::sphere, Law::linear_stiffness, 0.0},
                                             {Shape::sphere, Law::hertz_mindlin, 0.0},
                                             {Shape::sphere, Law::hertz_rough, 0.0},
                                             {Shape::sphere, Law::cones, 0.0},
                                             {Shape::disc, Law::linear_stiffness, 0.5},
                                             {Shape::disc, Law::linear_stiffness, 0.0}}) {
    const Clump clump = published_clump(shape == Shape::disc ? "triangle" : "square", dimension_of(shape));
    const auto add = [&](Specimen& s, double radius, const Vector3& x, const Turn& turn) {
      add_clump(s, clump, radius, x, turn);
    };
    check_impact(two_in_flight(shape, law, friction, add), 0.5);
  }
}

TEST_CASE("Two pairs of spheres side by side have two contacts and one neighbour each") {
  Specimen s = empty_specimen(Shape::sphere, 0.2, linear_material(1e6, 5e5, 0.5));
  const Clump pair = published_clump("pair", 3);
  const double apart = 2 * 0.01 * pair.members[0].radius * (1 - 1e-4);
  add_clump(s, pair, 0.01, Vector3::Zero(), Turn{});
  add_clump(s, pair, 0.01, {0, apart, 0}, Turn{});
  const Network network = Rve(s).network();
  CHECK(network.contacts.size() == 2);
  CHECK(coordination_number(network) == 2);
  CHECK(touching_neighbours(network) == 1);
}

TEST_CASE("A clump in flight turns as a free top") {
  Specimen s = empty_specimen(Shape::sphere, 0.2, linear_material(1e6, 5e5, 0.5));
  add_clump(s, clump_of("top", {{{0, 0, 0}, 1}, {{0.9, 0.3, 0}, 0.7}, {{-0.2, 0.8, 0.5}, 0.6}}, 3), 0.01,
            {0.01, 0.02, -0.03}, cayley_turn({0.3, -0.8, 0.4}));
  s.bodies[0].spin = {300, 200, -100};
  s.state.last_step.loading = Loading::at_rate;
  s.solver.fixed_time_step = 1e-5;
  const Conserved before = conserved_in(s);
  Rve rve(s);
  Vector3 moments = s.bodies[0].gyration,
          momentum = moments.cwiseProduct(axes_of(s.bodies[0].orientation).transpose() * s.bodies[0].spin);
  Turn q = s.bodies[0].orientation;
  for (int k = 0; k < 100; ++k) rve.apply(Matrix3::Zero(), 1e-3);
  for (int k = 0; k < 100'000; ++k) rotate_freely(1e-6, moments, momentum, q);  // ten times as fine
  const Body& body = rve.specimen().bodies[0];
  const Conserved held = conserved_in(rve.specimen());
  CHECK((held.angular - before.angular).norm() < 1e-10 * before.angular.norm());
  CHECK(std::abs(held.energy / before.energy - 1) < 1e-10);
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
    const Specimen alone = made_anew(spheres);
    Specimen clumps = alone;
    const Clump single = published_clump("single", dimension_of(shape));
    clumps.grains = Grains{};
    for (std::size_t g = 0; g < spheres.grains.size(); ++g)
      add_clump(clumps, single, spheres.grains.radius[g], spheres.grains.position[g], Turn{});
    clumps.grains.id = spheres.grains.id;
    Rve a(alone), b(clumps);
    CAPTURE(int(shape));
    check_same_path(a, b, 4, 1e-10);
    CHECK(std::abs(void_ratio(a.network()) - void_ratio(b.network())) < 1e-12);
    CHECK(coordination_number(a.network()) == coordination_number(b.network()));
  }
}

TEST_CASE("Clumps bear stress in balance; sums, network and records agree") {
  for (const auto& [shape, name] : {std::pair{Shape::disc, "triangle"}, {Shape::sphere, "tetrapod"}}) {
    const Specimen packed = pressed_clumps(shape, shape == Shape::disc ? 8 : 4, name, 11);
    Rve rve(packed);
    CAPTURE(name);
    const double pressure = mean_pressure(rve.stress(), rve.cell().dimension);
    check_balance(rve, packed.bodies);
    // Large shear: wrapped and reduced cells, members on other sides of the boundary than their centre.
    for (int k = 0; k < 4; ++k) rve.apply(gradient(0, 0.15, 0, 0), 0);
    check_specimen(rve.specimen());
    CHECK((contact_stress(rve.network()) - rve.contact_stress()).norm() < 1e-10 * pressure);
    CHECK(std::abs(orientation_fabric(rve.network()).trace() - 1) < 1e-12);
  }
}

TEST_CASE("A rigid rotation leaves clumps as they were") {
  check_rigid_rotation(Rve(pressed_clumps(Shape::sphere, 3, "pair", 5)));
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
  eight.solver.fixed_substeps = 50;
  Rve a(made_anew(one)), b(eight);
  check_same_path(a, b, 3, 1e-8);
}

TEST_CASE("Clumps go on with the same bits after a snapshot, a reverted trial and a release") {
  for (const double dt : {0.0, 1e-4}) check_same_bits(pressed_clumps(Shape::sphere, 3, "tetrapod", 4), dt, 0.05);
}

TEST_CASE("Clumps have the same bits by every instruction set") {
  for (const auto& [shape, name] : {std::pair{Shape::disc, "triangle"}, {Shape::sphere, "tetrapod"}}) {
    Specimen s = pressed_clumps(shape, shape == Shape::disc ? 5 : 3, name, 13);
    for (const LocalDampingForm form : {LocalDampingForm::vector, LocalDampingForm::component}) {
      s.damping.local = 0.3;
      s.damping.local_form = form;
      s.damping.global_viscous = form == LocalDampingForm::vector ? 0.1 : 0;
      s.contact.rolling = form == LocalDampingForm::component;
      s.materials[0].rolling_stiffness = s.materials[0].rolling_friction = 0.1;
      CAPTURE(name, int(form));
      check_instruction_sets(s);
    }
  }
}

TEST_CASE("The elastic tangent of clumps is what a small increment without slip answers") {
  check_elastic_tangent(pressed_clumps(Shape::sphere, 3, "pair", 21));
}

TEST_CASE("What clumps cannot do is refused") {
  Specimen s = clumps_in_a_crystal(Shape::sphere, 2, "pair", 0.003, 1);
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
