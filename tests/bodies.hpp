// Clumps and superellipsoids under test: crystals of them pressed together, two that meet, and the laws that hold for
// any bodies.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "rvelab/measure/measures.hpp"
#include "rvelab/measure/tangent.hpp"
#include "rvelab/specimen/clumps.hpp"
#include "rvelab/specimen/solids.hpp"
#include "tests/solver/instruction_set.hpp"
#include "tests/specimens.hpp"

namespace rvelab::test {

inline Turn any_turn(int dimension, std::mt19937_64& generator) {
  const auto uniform = [&] { return 2 * double(generator() >> 11) / 9007199254740992.0 - 1; };
  if (dimension == 2) return normalised(Turn{uniform(), {0, 0, uniform()}});
  return normalised(Turn{uniform(), {uniform(), uniform(), uniform()}});
}

/// For both linear and Hertz contacts.
inline Material body_material(double friction = 0.5) {
  Material m = linear_material(1e6, 5e5, friction);
  m.young_modulus = 1e8;
  m.poisson_ratio = 0.2;
  m.roughness = 5e-6;
  m.cone_slope = 0.05;
  return m;
}

/// An ellipsoid and a superellipsoid, half axes over half the spacing of a crystal.
inline constexpr Superellipsoid ellipsoid{1.25, 1, 0.8, 2, 2}, blocky{1.2, 1, 0.9, 4, 3};

inline Superellipsoid times_as_large(Superellipsoid s, double factor) {
  s.a *= factor;
  s.b *= factor;
  s.c *= factor;
  return s;
}

/// add(specimen, position, turn) at the sites of a crystal of side^d, turned anyhow; the spacing is 0.01 m.
template <class Add>
Specimen crystal_of_bodies(Shape shape, int side, std::uint64_t seed, Law law, Add add) {
  const int d = dimension_of(shape);
  const double spacing = 0.01;
  Specimen s = empty_specimen(shape, side * spacing, body_material(), law);
  if (d == 2) s.cell.lattice(2, 2) = spacing;
  s.solver.max_overlap_ratio = 0.8;
  std::mt19937_64 generator(seed);
  for (int k = 0; k < (d == 2 ? 1 : side); ++k)
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i) {
        Vector3 x = Vector3(i, j, k) * spacing - 0.5 * (side - 1) * spacing * Vector3::Ones();
        if (d == 2) x[2] = 0;
        add(s, x, any_turn(d, generator));
      }
  return s;
}

inline Specimen clumps_in_a_crystal(Shape shape, int side, const char* name, double radius, std::uint64_t seed,
                                    Law law = Law::linear_stiffness) {
  const Clump clump = published_clump(name, dimension_of(shape));
  return crystal_of_bodies(shape, side, seed, law, [&](Specimen& s, const Vector3& x, const Turn& turn) {
    add_clump(s, clump, radius, x, turn);
  });
}

/// Brought to rest under 5 kPa or more.
inline Specimen pressed(const Specimen& s) {
  Rve rve(s);
  const int d = rve.cell().dimension;
  rve.relax(1e-4, 20'000);
  Matrix3 smaller = Matrix3::Zero();
  for (int k = 0; k < d; ++k) smaller(k, k) = -5e-3;
  for (int round = 0; round < 60 && mean_pressure(rve.stress(), d) < 5e3; ++round) {
    rve.apply(smaller, 0);
    rve.relax(1e-4, 5'000);
  }
  rve.relax(1e-6, 50'000);
  return rve.specimen();
}

inline Specimen pressed_clumps(Shape shape, int side, const char* name, std::uint64_t seed) {
  return pressed(clumps_in_a_crystal(shape, side, name, 0.005, seed));
}

inline Specimen pressed_solids(int side, const Superellipsoid& shape, std::uint64_t seed,
                               Law law = Law::linear_stiffness) {
  return pressed(
      crystal_of_bodies(Shape::superellipsoid, side, seed, law, [&](Specimen& s, const Vector3& x, const Turn& turn) {
        add_superellipsoid(s, times_as_large(shape, 0.005), x, turn);
      }));
}

/// add(specimen, size, position, turn): two that fly at each other off centre and turn.
template <class Add>
Specimen two_in_flight(Shape shape, Law law, double friction, Add add) {
  Specimen s = empty_specimen(shape, 0.2, body_material(friction), law);
  const int d = dimension_of(shape);
  std::mt19937_64 generator(7);
  add(s, 0.01, Vector3(-0.02, 0.003, 0), any_turn(d, generator));
  add(s, 0.012, Vector3(0.02, -0.004, 0), any_turn(d, generator));
  s.bodies[0].velocity = {1, 0.1, 0};
  s.bodies[1].velocity = -s.bodies[0].volume / s.bodies[1].volume * s.bodies[0].velocity;
  s.bodies[0].spin = d == 2 ? Vector3(0, 0, 20) : Vector3(10, -15, 20);
  s.state.last_step.loading = Loading::at_rate;
  s.solver.fixed_time_step = 2e-7;
  return s;
}

/// Momentum, angular momentum about the origin and kinetic energy of bodies of one material.
struct Conserved {
  Vector3 momentum = Vector3::Zero(), angular = Vector3::Zero();
  double energy = 0;
};
inline Conserved conserved_in(const Specimen& s) {
  Conserved sum;
  for (const Body& body : s.bodies) {
    const double mass = s.materials[0].density * body.volume;
    const Matrix3 axes = axes_of(body.orientation);
    const Vector3 spun = mass * (axes * body.gyration.asDiagonal() * axes.transpose()) * body.spin;
    sum.momentum += mass * body.velocity;
    sum.angular += mass * body.position.cross(body.velocity) + spun;
    sum.energy += 0.5 * (mass * body.velocity.squaredNorm() + body.spin.dot(spun));
  }
  return sum;
}

/// Quasi-static loading and loading at a rate, in a frame that turns, have the same bits by every instruction set.
inline void check_instruction_sets(Specimen s) {
  s.solver.fixed_substeps = 60;
  for (const double dt : {0.0, 1e-3}) {
    std::vector<std::byte> scalar;
    for (const char* name : {"scalar", "baseline", "v3", "v4"}) {
      CAPTURE(name, dt);
      const InstructionSet chosen(name);
      try {
        Rve rve(s);
        rve.apply(gradient(-1e-3, 3e-3, 0, 5e-4), dt);
        rve.apply(gradient(0, 1e-3, 2e-3, 0), dt);
        if (scalar.empty()) scalar = rve.save();
        CHECK(bool(rve.save() == scalar));
      } catch (const InputError&) {
        WARN(std::string("not on this processor: ") + name);
      }
    }
  }
}

/// Two that meet and part. Without friction the energy is kept too: what tangential springs hold ends as the contact
/// opens. `slowed`: below that velocity, m/s, the first has met the second.
inline void check_impact(const Specimen& s, double slowed) {
  Rve rve(s);
  const Conserved before = conserved_in(s);
  bool touched = false;
  double error = 0;
  for (int k = 0; k < 50; ++k) {
    rve.apply(Matrix3::Zero(), 1e-3);
    const Specimen now = rve.specimen();
    touched = touched || !rve.network().contacts.empty() || now.bodies[0].velocity[0] < slowed;
    const Conserved held = conserved_in(now);
    CHECK(held.momentum.norm() < 1e-12 * s.materials[0].density * s.bodies[0].volume);
    error = std::max(error, (held.angular - before.angular).norm() / before.angular.norm());
  }
  const double change = conserved_in(rve.specimen()).energy / before.energy - 1;
  CAPTURE(int(s.shape), int(s.contact.law), s.materials[0].friction, touched, error, change);
  CHECK(touched);
  CHECK(rve.network().contacts.empty());
  CHECK(error < 1e-10);
  CHECK(change < 2e-4);
  if (s.materials[0].friction == 0) CHECK(change > -2e-4);
}

/// Without contacts, motion and state, in 50 sub-steps an increment.
inline Specimen made_anew(Specimen s) {
  s.contacts.clear();
  s.state = SolverState{};
  for (auto* v : {&s.grains.velocity, &s.grains.spin}) std::fill(v->begin(), v->end(), Vector3::Zero());
  for (Body& body : s.bodies) body.velocity = body.spin = Vector3::Zero();
  s.solver.fixed_substeps = 50;
  return s;
}

/// The same path of two specimens: stress to `tolerance` of the pressure. The first increment is from the start.
inline void check_same_path(Rve& a, Rve& b, int increments, double tolerance) {
  const double pressure = mean_pressure(a.stress(), a.cell().dimension);
  REQUIRE(pressure > 0);
  CHECK((a.stress() - b.stress()).norm() < 1e-10 * pressure);
  for (int k = 0; k < increments; ++k) {
    for (Rve* each : {&a, &b}) each->apply(gradient(-5e-5, 3e-5, 0, 2e-5), 0);
    CAPTURE(k, a.stress() - b.stress(), pressure);
    CHECK((a.stress() - b.stress()).norm() < tolerance * pressure);
  }
}

/// Pressed bodies bear stress in balance; sums and network agree. In balance of forces and moments the stress is
/// symmetric; that of the members' branches is not the same.
inline void check_balance(const Rve& rve, const std::vector<Body>& bodies) {
  const double pressure = mean_pressure(rve.stress(), rve.cell().dimension);
  CAPTURE(pressure, rve.unbalanced_ratio());
  CHECK(pressure > 1e3);
  CHECK(rve.unbalanced_ratio() < 1e-5);
  const Network network = rve.network();
  CHECK(network.grains.size() == bodies.size());
  CHECK((contact_stress(network) - rve.contact_stress()).norm() < 1e-12 * pressure);
  CHECK((rve.stress() - rve.stress().transpose()).norm() < 1e-3 * pressure);
  CHECK(unbalanced_force_ratio(network) < 1e-4);
  CHECK(unbalanced_torque_ratio(network) < 1e-4);
  double solid = 0;
  for (const Body& body : bodies) solid += body.volume;
  CHECK(std::abs(void_ratio(network) - (rve.cell().volume() - solid) / solid) < 1e-10);
}

inline void check_rigid_rotation(Rve rve) {
  const Matrix3 before = rve.stress();
  const Matrix3 turn = Eigen::AngleAxisd(0.7, Vector3(1, -2, 0.5).normalized()).toRotationMatrix();
  rve.apply(turn - Matrix3::Identity(), 0);
  CHECK((rve.stress() - turn * before * turn.transpose()).norm() < 1e-12 * before.norm());
}

/// The same bits after a snapshot, a reverted trial and a release. `shear`: of each increment after these.
inline void check_same_bits(const Specimen& s, double dt, double shear) {
  Rve rve(s);
  rve.apply(gradient(-1e-3, 2e-3, 0, 5e-4), dt);
  Rve other(rve.specimen());
  Rve restored(disordered(Shape::sphere, 3, linear_material(1e6, 5e5, 0.5), Law::linear_stiffness, 0.4, 1));
  restored.restore(rve.save());
  rve.attempt(gradient(2e-3, 0, 0, -1e-3), dt);
  rve.revert();
  CHECK(rve.save() == other.save());
  rve.release();
  for (int k = 0; k < 3; ++k)
    for (Rve* each : {&rve, &other, &restored}) each->apply(gradient(-1e-3, shear, 0, 5e-4), dt);
  CHECK(rve.save() == other.save());
  CHECK(rve.save() == restored.save());
}

/// The elastic tangent is what a small increment without slip answers.
inline void check_elastic_tangent(Specimen s) {
  s.materials[0].friction = 1e6;
  s.solver.target_unbalanced = 1e-9;
  Rve rve(s);
  rve.relax(1e-9, 200'000);
  const Eigen::MatrixXd tangent = elastic_tangent(rve.network());
  const double strain = 1e-6;
  Rve smaller = rve;
  const Matrix3 before = rve.stress();
  smaller.apply(gradient(-strain, 0, 0, 0), 0);
  smaller.relax(1e-9, 200'000);
  const double measured = (before(0, 0) - smaller.stress()(0, 0)) / strain;
  CAPTURE(measured, tangent(0, 0));
  CHECK(std::abs(measured / tangent(0, 0) - 1) < 0.01);
}

}  // namespace rvelab::test
