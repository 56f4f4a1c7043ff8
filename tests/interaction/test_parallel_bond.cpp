// Two bonded grains against the formulas of a beam (Potyondy and Cundall 2004): each load alone and all together,
// before and at breaking. The grains are so heavy that forces do not move them: what they do is prescribed, to the last
// bit.
#include "tests/interaction/bonded_pair.hpp"
#include "tests/solver/instruction_set.hpp"

using namespace rvelab;
using namespace rvelab::test;
using namespace rvelab::test::bonded;

namespace {

struct Strength {
  double tensile = 1e30, cohesion = 1e30, friction = 0, moment_factor = 1;
};

Rve bonded_pair(Shape shape, const Strength& strength = {}) {
  std::vector<double> columns = beam_columns<ParallelBond>();
  columns[ParallelBond::tensile_strength] = strength.tensile;
  columns[ParallelBond::cohesion] = strength.cohesion;
  columns[ParallelBond::friction] = strength.friction;
  columns[ParallelBond::moment_factor] = strength.moment_factor;
  return pair_with<ParallelBond>(shape, columns);
}

}  // namespace

TEST_CASE("a bond is a beam: tension, slip, bending, twist, each to 1e-10 of its scale", "[bond]") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    const bool plane = dimension_of(shape) == 2;
    INFO(name(shape));
    const Section section = section_of(shape, bond_radius);
    const double time = 100 * step;
    {
      Rve rve = bonded_pair(shape);
      move(rve, {{1e-3, 0, 0}, none, none}, 100);
      const double force = kn * section.area * 2e-3 * time;
      // Stress of one force along one branch: tension f l/V.
      CHECK(rve.contact_stress()(0, 0) == Approx(force * (l0 + 2e-3 * time) / rve.cell().volume()).epsilon(1e-10));
      CHECK(largest(rve.contact_stress() - Matrix3(rve.contact_stress().diagonal().asDiagonal())) < 1e-10 * force);
    }
    {
      Rve rve = bonded_pair(shape);
      const double w = 1e-3;
      move(rve, {none, {0, 0, w}, {0, 0, w}}, 100);
      const Bond bond = bonds_of(rve).front();
      // Grains that roll over each other: the arms halve the gap, and their sum is the branch.
      const double shear = ks * section.area * l0 * w * time;
      CHECK(triple(bond, ParallelBond::shear_force)[plane ? 0 : 1] == Approx(shear).epsilon(1e-10));
      CHECK(triple(bond, ParallelBond::bending_moment).norm() < 1e-10 * shear);
      // Each grain is turned back by its arm.
      const Network net = rve.network();
      CHECK(net.grains[0].torque[2] == Approx(-(ri + 0.05) * shear).epsilon(1e-10));
      CHECK(net.grains[1].torque[2] == Approx(-(rj + 0.05) * shear).epsilon(1e-10));
      CHECK(net.grains[1].resultant[1] == Approx(shear).epsilon(1e-10));
    }
    {
      Rve rve = bonded_pair(shape);
      const double w = 1e-3;
      move(rve, {none, {0, 0, -(rj + 0.05) * w}, {0, 0, (ri + 0.05) * w}}, 100);
      const Bond bond = bonds_of(rve).front();
      const double moment = -kn * section.inertia * l0 * w * time;
      CHECK(triple(bond, ParallelBond::bending_moment)[2] == Approx(moment).epsilon(1e-10));
      CHECK(triple(bond, ParallelBond::shear_force).norm() < 1e-10 * std::abs(moment));
      const Network net = rve.network();
      CHECK(net.grains[0].torque[2] == Approx(-moment).epsilon(1e-10));
      CHECK(net.grains[1].torque[2] == Approx(moment).epsilon(1e-10));
      CHECK(net.interactions.front().elastic_energy ==
            Approx(0.5 * moment * moment / (kn * section.inertia)).epsilon(1e-10));
    }
    if (plane) continue;
    Rve rve = bonded_pair(shape);
    const double w = 1e-3;
    move(rve, {none, {-w, 0, 0}, {w, 0, 0}}, 100);
    const double moment = -ks * section.polar * 2 * w * time;
    CHECK(column(bonds_of(rve).front(), ParallelBond::twisting_moment) == Approx(moment).epsilon(1e-10));
    const Network net = rve.network();
    CHECK(net.grains[0].torque[0] == Approx(-moment).epsilon(1e-10));
    CHECK(net.grains[1].torque[0] == Approx(moment).epsilon(1e-10));
  }
}

TEST_CASE("a bond breaks in the step in which the stress at its rim passes the strength", "[bond]") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    const Section section = section_of(shape, bond_radius);
    INFO(name(shape));
    // Tension and bending: after k steps the rim has kn v k h + beta kn w R k h.
    for (const double factor : {1.0, 0.25, 0.0}) {
      const double v = 1e-3, w = 2e-3, rate = kn * (2 * v + factor * w * bond_radius);
      const double strength = rate * 60.5 * step;
      Rve rve = bonded_pair(shape, {strength, 1e30, 0, factor});
      const double arms = ri + rj + 0.1;
      const Motion motion{{v, 0, 0}, {0, 0, -(rj + 0.05) / arms * w}, {0, 0, (ri + 0.05) / arms * w}};
      move(rve, motion, 60);
      CHECK(column(bonds_of(rve).front(), ParallelBond::broken) == 0);
      CHECK(rve.network().interactions.size() == 1);
      const double elongation = branch_of(rve) - l0;
      move(rve, motion, 1);
      const Bond bond = bonds_of(rve).front();
      CHECK(column(bond, ParallelBond::broken) == 1);
      CHECK(largest(rve.contact_stress()) == 0);
      CHECK(rve.network().interactions.empty());
      // What it held in the step in which it broke.
      const double last = elongation * 61 / 60, turn = w * 61 * step;
      const double energy = 0.5 * kn * section.area * last * last + 0.5 * kn * section.inertia * turn * turn;
      CHECK(column(bond, ParallelBond::released) == Approx(energy).epsilon(1e-4));
      // And never comes back, however the grains lie.
      move(rve, {{-v, 0, 0}, none, none}, 200);
      CHECK(largest(rve.contact_stress()) == 0);
      CHECK(column(bonds_of(rve).front(), ParallelBond::broken) == 1);
    }
    // Slip under pressure: tau = ks u, strength c + tan(phi) sigma, sigma = kn times the shortening.
    const double shortening = 0.02, friction = 0.5, pressure = kn * shortening, strength = 1e3 + friction * pressure;
    const double w = strength / (ks * l0) / (80.5 * step);
    Rve rve = bonded_pair(shape, {1e30, 1e3, friction, 1});
    move(rve, {{-0.5 * shortening / (50 * step), 0, 0}, none, none}, 50);
    const double branch = branch_of(rve), rate = w * l0 / branch;
    move(rve, {none, {0, 0, rate}, {0, 0, rate}}, 80);
    CHECK(column(bonds_of(rve).front(), ParallelBond::broken) == 0);
    move(rve, {none, {0, 0, rate}, {0, 0, rate}}, 1);
    CHECK(column(bonds_of(rve).front(), ParallelBond::broken) == 2);
  }
  // Twist alone: tau = beta |M_t| R/J = beta ks R theta.
  const double w = 1e-3;
  Rve rve = bonded_pair(Shape::sphere, {1e30, 0.5 * ks * bond_radius * 2 * w * 40.5 * step, 0, 0.5});
  move(rve, {none, {-w, 0, 0}, {w, 0, 0}}, 40);
  CHECK(column(bonds_of(rve).front(), ParallelBond::broken) == 0);
  move(rve, {none, {-w, 0, 0}, {w, 0, 0}}, 1);
  CHECK(column(bonds_of(rve).front(), ParallelBond::broken) == 2);
}

TEST_CASE("a thousand turns of a bonded pair change nothing", "[bond]") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    Rve rve = bonded_pair(shape);
    move(rve, {{1e-3, 0, 0}, {1e-3, 0, 2e-3}, {-1e-3, 0, 1e-3}}, 50);
    rve.set_velocities({Vector3::Zero(), Vector3::Zero()}, {Vector3::Zero(), Vector3::Zero()});
    const Matrix3 before = rve.cell().rotation.transpose() * rve.contact_stress() * rve.cell().rotation;
    const double energy = rve.network().interactions.front().elastic_energy;
    for (int k = 0; k < 8'000; ++k) rve.apply(rotation_about_z(pi / 4) - Matrix3::Identity(), 0);
    const Matrix3 after = rve.cell().rotation.transpose() * rve.contact_stress() * rve.cell().rotation;
    CHECK(largest(after - before) <= 1e-12 * largest(before));
    CHECK(rve.network().interactions.front().elastic_energy == Approx(energy).epsilon(1e-12));
  }
}

TEST_CASE("every instruction set moves bonds by the same bits", "[bond]") {
  const Material m = linear_material(2e6, 1e6, 0.4);
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    const int side = dimension_of(shape) == 2 ? 9 : 5;
    Specimen s = disordered(shape, side, m, Law::linear_stiffness, 0.505, 3);
    s.contact.rolling = true;
    Rve packed = at_rest(s, 1e-6);
    protocol::Cementation cement = cement_of(1e6);
    cement.strength_scatter = 0.36;
    packed.set_interactions(protocol::cemented(packed, cement));
    REQUIRE(bonds_of(packed).size() > packed.size());
    const Specimen cemented = packed.specimen();
    std::vector<std::byte> reference;
    for (const char* isa : {"scalar", "baseline", "v3", "v4"}) {
      const InstructionSet set(isa);
      std::optional<Rve> rve;
      try {
        rve.emplace(cemented);
      } catch (const InputError&) {
        continue;  // this machine has it not
      }
      INFO(name(shape) << ", " << isa);
      for (int k = 0; k < 6; ++k) rve->apply(gradient(-1e-3, 4e-3, 0, 1e-3), k % 2 == 0 ? 0 : 1e-3);
      if (reference.empty()) {
        reference = rve->save();
        const auto bonds = bonds_of(*rve);
        const auto broken = std::count_if(bonds.begin(), bonds.end(),
                                          [](const Bond& b) { return column(b, ParallelBond::broken) > 0; });
        CHECK(broken > 5);  // else nothing of what breaking does is compared
        CHECK(std::size_t(broken) < bonds.size());
      }
      CHECK(rve->save() == reference);
    }
  }
}
