// What a quasi-static increment says of itself: balance of forces and torques, and whether it is one at all.
#include "tests/catch.hpp"
#include "tests/extreme/specimens.hpp"
#include "tests/refusal.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

Specimen dense(double friction, double rolling_stiffness = 0) {
  Material m = material(1e6, 5e5, friction);
  m.rolling_stiffness = rolling_stiffness;
  m.rolling_friction = 0.1;
  Specimen s = packed(gas(2, spread_radii(60, 0.2), 0.4, 3, m), 2e3);
  s.contact.rolling = rolling_stiffness > 0;
  return s;
}

}  // namespace

TEST_CASE("a stiff rolling spring leaves the stress as symmetric as the unbalanced ratio says, and right") {
  const double beta = GENERATE(1.0, 1e3, 1e5);
  CAPTURE(beta);
  const Specimen s = dense(0.5, beta);
  const Matrix3 shear = entry(0, 1, 2e-4);
  Rve rve(s);
  const double p = mean_pressure(rve.stress(), 2);
  Response response;
  for (int k = 0; k < 5; ++k) {
    response = rve.apply(shear, 0);
    const double couple = std::abs(response.stress(0, 1) - response.stress(1, 0));
    CHECK(couple < 1.5 * response.report.unbalanced_ratio * p + 1e-9 * p);
  }
  Specimen fine = s;
  fine.solver.fixed_substeps = 40'000;
  Rve resolved(fine);
  Matrix3 stress;
  for (int k = 0; k < 5; ++k) stress = resolved.apply(shear, 0).stress;
  CHECK((response.stress - stress).norm() < 0.01 * p);
}

TEST_CASE("the unbalanced ratio of an RVE is that of forces or of torques, as measured on its network") {
  Rve rve(dense(0.5, 100));
  rve.apply(entry(0, 1, 1e-3), 0);
  const Network network = rve.network();
  const double force = unbalanced_force_ratio(network), torque = unbalanced_torque_ratio(network);
  CHECK(std::abs(rve.unbalanced_ratio() - std::max(force, torque)) < 1e-12);
  CHECK(torque > 0);
}

TEST_CASE("an increment that ends out of balance says so") {
  Specimen s = dense(0.5);
  Rve slow(s);
  CHECK(slow.apply(entry(0, 1, 1e-5), 0).report.in_equilibrium);
  s.solver.fixed_substeps = 2;  // far too few
  Rve fast(s);
  const Report report = fast.apply(entry(0, 1, 5e-3), 0).report;
  CHECK(report.unbalanced_ratio > 3e-3);
  CHECK_FALSE(report.in_equilibrium);
}

TEST_CASE("a packing whose friction is lowered is no equilibrium, and its first increment says so, however small") {
  // An increment of 1e-5 takes sub-steps enough to find an equilibrium: what it says is held against one that is found.
  Specimen s = dense(0.5);
  Rve rve(s);
  for (int k = 0; k < 10; ++k) rve.apply(entry(0, 1, 2e-4), 0);
  rve.relax(1e-5, 20'000);
  const Specimen at_rest = rve.specimen();
  for (const double strain : {1e-9, 1e-7, 1e-6, 1e-5})
    for (const double friction : {0.0, 0.05}) {
      CAPTURE(strain, friction);
      Specimen kept = at_rest;
      for (Material& m : kept.materials) m.friction = friction;
      Specimen fresh = kept;
      fresh.state = {};
      Rve lowered(at_rest), opened(kept), anew(fresh);
      lowered.set_materials(kept.materials);
      for (Rve* one : {&lowered, &opened, &anew}) {
        const Response first = one->apply(entry(0, 1, strain), 0);
        Rve found = *one;
        found.relax(1e-7, 100'000);
        const double missed = (found.stress() - first.stress).norm();
        CHECK(missed < first.report.error_estimate);
        CHECK((strain > 5e-6 || missed > 5e-3 * first.stress.norm()));
        CHECK((strain > 5e-6 || first.report.unbalanced_ratio > 5e-3));
        const double target = one->specimen().state.control.target_unbalanced_ratio;
        CHECK(first.report.in_equilibrium == (first.report.unbalanced_ratio <= 3 * target));
        CHECK((!first.report.in_equilibrium || first.report.unbalanced_ratio < 3e-3));
        CHECK((strain > 5e-6 || one->apply(entry(0, 1, strain), 0).report.unbalanced_ratio > 5e-3));
      }
    }
}

TEST_CASE("a tangential force without a stiffness is refused, and let go of where a material loses it") {
  Specimen s = dense(0.5);
  Rve rve(s);
  rve.apply(entry(0, 1, 1e-3), 0);
  Specimen held = rve.specimen();
  REQUIRE_FALSE(held.contacts.empty());
  held.materials[0].tangential_stiffness = 0;
  const std::string text = input_error([&] { Rve refused(held); });
  CHECK(contains(text, "holds a tangential force of"));
  CHECK(contains(text, "clear the tangential forces"));

  Specimen booked = rve.specimen();
  booked.solver.energy_balance = true;
  Rve live(booked);
  double stored = 0;
  for (const ContactState& c : live.network().contacts)
    stored += 0.5 * c.tangential_force.squaredNorm() / c.tangential_stiffness;
  const double before = live.specimen().state.energy_balance.law_loss;
  live.set_materials(held.materials);
  for (const ContactState& c : live.network().contacts) CHECK(c.tangential_force.norm() < 1e-12 * c.normal_force);
  CHECK(std::abs(live.specimen().state.energy_balance.law_loss - before - stored) < 1e-12 * stored);
}

TEST_CASE("a dashpot does nothing at dt = 0") {
  const int dimension = GENERATE(2, 3);
  Specimen plain =
      packed(gas(dimension, spread_radii(40, 0.1), dimension == 2 ? 0.4 : 0.25, 3, material(1e6, 5e5, 0.4)), 2e3);
  Specimen damped = plain;
  damped.damping.dashpot = Dashpot::restitution;
  damped.damping.restitution = 0.1;
  damped.damping.tangential_ratio = 0.5;
  Rve a(plain), b(damped);
  for (int k = 0; k < 5; ++k) CHECK(a.apply(entry(0, 1, 1e-3), 0).stress == b.apply(entry(0, 1, 1e-3), 0).stress);
}

TEST_CASE("the energy balance counts what a rolling spring holds when its contact opens") {
  Specimen s = dense(0.5, 1.0);
  s.materials[0].rolling_friction = 10;
  s.solver.energy_balance = true;
  s.solver.max_overlap_ratio = 0.9;
  Rve rve(s);
  const auto energy = [&] {
    const Network n = rve.network();
    return kinetic_energy(n) + elastic_energy(n);
  };
  rve.apply(entry(0, 1, 0.02), 0.02 / 0.3);
  const double before = energy();
  const EnergyTerms start = rve.specimen().state.energy_balance;
  Matrix3 open = entry(0, 1, 0.02);
  open(0, 0) = open(1, 1) = 0.02;
  rve.apply(open, 0.02 / 0.3);
  const EnergyTerms end = rve.specimen().state.energy_balance;
  const double work = end.boundary_work - start.boundary_work, rolling = end.rolling - start.rolling;
  const double lost = end.friction - start.friction + rolling + end.removed_kinetic - start.removed_kinetic;
  CHECK(rolling > 0);
  CHECK(std::abs(energy() - before - work + lost) < 0.5 * rolling);  // the rest is that of a coarse step
}
