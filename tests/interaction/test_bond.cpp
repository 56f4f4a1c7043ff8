// Two grains bonded by a surface of their load, or at a point, against the formulas of surface_bond.hpp and
// contact_bond.hpp: what breaks them, in which step; and cement stages that make them.
#include "tests/interaction/bonded_pair.hpp"

using namespace rvelab;
using namespace rvelab::test;
using namespace rvelab::test::bonded;

namespace {

constexpr double tensile = 3e3, tan_friction = 0.7, bending_factor = 0.2, twisting_factor = 0.3;

Rve surface_pair(Shape shape) {
  std::vector<double> columns = beam_columns<SurfaceBond>();
  columns[SurfaceBond::tensile_strength] = tensile;
  columns[SurfaceBond::shear_factor] = tan_friction;
  columns[SurfaceBond::bending_factor] = bending_factor;
  columns[SurfaceBond::twisting_factor] = twisting_factor;
  return pair_with<SurfaceBond>(shape, columns);
}

Rve contact_bonded(Shape shape, double pull, double slip, double friction) {
  std::vector<double> columns(interaction_columns<ContactBond>());
  columns[ContactBond::first_gap] = l0 - (ri + rj);
  columns[ContactBond::normal_stiffness] = kn;
  columns[ContactBond::shear_stiffness] = ks;
  columns[ContactBond::tensile_strength] = pull;
  columns[ContactBond::shear_strength] = slip;
  columns[ContactBond::friction] = friction;
  return pair_with<ContactBond>(shape, columns);
}

/// Whole after `before` steps of `motion`, broken `how` after one more.
template <class Law>
void breaks_after(Rve& rve, const Motion& motion, long before, double how) {
  move(rve, motion, before);
  CHECK(column_of<Law>(rve, Law::broken) == 0);
  move(rve, motion, 1);
  CHECK(column_of<Law>(rve, Law::broken) == how);
  CHECK(rve.network().interactions.empty());
}

/// Grains that roll on each other: slip alone, `rate` per unit of branch.
Motion rolling(double rate) { return {none, {0, 0, rate}, {0, 0, rate}}; }
/// Turning against each other about z without slip.
Motion bending(double rate, double branch) {
  const double half = 0.5 * (branch - (ri + rj));
  return {none, {0, 0, -(rj + half) / branch * rate}, {0, 0, (ri + half) / branch * rate}};
}

}  // namespace

TEST_CASE("a surface bond breaks where its load leaves the surface", "[bond]") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    const Section section = section_of(shape, bond_radius);
    for (const double sigma : {-0.5 * tensile, 0.0, 2 * tensile}) {  // pressure on the bond
      INFO(name(shape) << ", pressure " << sigma);
      const double margin = (sigma + tensile) * section.area, shortening = sigma / kn;
      const auto pressed = [&] {
        Rve rve = surface_pair(shape);
        if (sigma != 0) move(rve, {{-0.5 * shortening / (50 * step), 0, 0}, none, none}, 50);
        CHECK(column_of<SurfaceBond>(rve, SurfaceBond::broken) == 0);
        return rve;
      };
      const double branch = l0 - shortening, how = sigma < 0 ? 1 : 2;
      {
        Rve rve = pressed();
        const double slip = tan_friction * margin / (ks * section.area);
        breaks_after<SurfaceBond>(rve, rolling(slip / branch / (60.5 * step)), 60, how);
      }
      const double turn = bending_factor * bond_radius * margin / (kn * section.inertia);
      {
        Rve rve = pressed();
        breaks_after<SurfaceBond>(rve, bending(turn / (60.5 * step), branch), 60, how);
      }
      {
        // 0.8 of the bending that breaks alone, then 0.6 of the slip.
        Rve rve = pressed();
        move(rve, bending(0.8 * turn / (40 * step), branch), 40);
        const double slip = 0.6 * tan_friction * margin / (ks * section.area);
        breaks_after<SurfaceBond>(rve, rolling(slip / branch / (60.5 * step)), 60, how);
      }
      if (dimension_of(shape) == 2) continue;
      Rve rve = pressed();
      const double twist = twisting_factor * bond_radius * margin / (ks * section.polar) / (60.5 * step);
      breaks_after<SurfaceBond>(rve, {none, {-0.5 * twist, 0, 0}, {0.5 * twist, 0, 0}}, 60, how);
    }
    Rve rve = surface_pair(shape);
    breaks_after<SurfaceBond>(rve, {{0.5 * tensile / kn / (60.5 * step), 0, 0}, none, none}, 60, 1);
  }
}

TEST_CASE("a contact bond bears pulls and slip, no pressure and no moment, and breaks at its two forces", "[bond]") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    INFO(name(shape));
    const double pull = 4e3, slip = 2e3, friction = 0.5;
    {
      Rve rve = contact_bonded(shape, pull, slip, friction);
      move(rve, bending(1e-2, l0), 100);
      const Network net = rve.network();
      CHECK(net.grains[0].torque.norm() < 1e-9 * kn * 1e-3);
      CHECK(net.grains[1].resultant.norm() < 1e-9 * kn * 1e-3);
      move(rve, {{-1e-3, 0, 0}, none, none}, 10);  // shorter, and no contact yet
      CHECK(rve.network().grains[1].resultant.norm() < 1e-9 * kn * 1e-3);
    }
    {
      Rve rve = contact_bonded(shape, pull, slip, friction);
      const double rate = 0.5 * pull / kn / (60.5 * step);
      move(rve, {{rate, 0, 0}, none, none}, 30);
      CHECK(-rve.network().grains[1].resultant[0] == Approx(pull * 30 / 60.5).epsilon(1e-9));
      breaks_after<ContactBond>(rve, {{rate, 0, 0}, none, none}, 30, 1);
      const double last = pull * 61 / 60.5;
      CHECK(column_of<ContactBond>(rve, ContactBond::released) == Approx(0.5 * last * last / kn).epsilon(1e-9));
    }
    // Slip, without and under pressure on the bond.
    for (const double pressure : {0.0, 3e3}) {
      Rve rve = contact_bonded(shape, pull, slip, friction);
      const double shortening = pressure / kn;
      if (pressure > 0) move(rve, {{-0.5 * shortening / (50 * step), 0, 0}, none, none}, 50);
      const double limit = (slip + friction * pressure) / ks, branch = l0 - shortening;
      breaks_after<ContactBond>(rve, rolling(limit / branch / (60.5 * step)), 60, 2);
    }
  }
}

TEST_CASE("a softening bond is a beam to its strength, then a straight line to the opening of its energy", "[bond]") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    INFO(name(shape));
    const Section section = section_of(shape, bond_radius);
    const double sigma = 4e3, energy = 3 * sigma * sigma / (2 * kn);  // r_f = 3
    const auto pair = [&] {
      std::vector<double> columns(interaction_columns<SofteningBond>());
      columns[SofteningBond::first_gap] = l0 - (ri + rj);
      columns[SofteningBond::radius] = bond_radius;
      columns[SofteningBond::normal_stiffness] = kn;
      columns[SofteningBond::shear_stiffness] = ks;
      columns[SofteningBond::tensile_strength] = sigma;
      columns[SofteningBond::cohesion] = 2 * sigma;
      columns[SofteningBond::moment_factor] = 1;
      columns[SofteningBond::last_share] = 3;
      return pair_with<SofteningBond>(shape, columns);
    };
    const double opening = sigma / kn, rate = 0.5 * opening / (1000 * step);  // strength after 1000 steps
    Rve rve = pair();
    const auto pull_of = [](const Rve& now) { return -now.network().grains[1].resultant[0]; };
    double done = 0, last = 0;
    for (int k = 1; k <= 320; ++k) {
      move(rve, {{rate, 0, 0}, none, none}, 10);
      const double u = 0.01 * k * opening, pull = pull_of(rve);
      const double exact = u < opening ? kn * u : std::max(0.0, sigma * (3 * opening - u) / (2 * opening));
      CHECK(pull == Approx(section.area * exact).margin(1e-8 * section.area * sigma));
      done += 0.5 * (pull + last) * 0.01 * opening;
      last = pull;
      if (k == 150) {  // half way down: back along the secant, and on
        CHECK(rve.network().interactions.front().normal_stiffness == Approx(pull / (1.5 * opening)).epsilon(1e-6));
        Rve back(rve);
        move(back, {{-rate, 0, 0}, none, none}, 750);
        CHECK(pull_of(back) == Approx(0.5 * pull).epsilon(1e-8));
        move(back, {{-rate, 0, 0}, none, none}, 1250);  // pressure is borne whole
        CHECK(pull_of(back) == Approx(-section.area * kn * 0.5 * opening).epsilon(1e-8));
      }
    }
    CHECK(column_of<SofteningBond>(rve, SofteningBond::broken) == 1);
    CHECK(done == Approx(energy * section.area).epsilon(1e-3));
    CHECK(column_of<SofteningBond>(rve, SofteningBond::released) == Approx(energy * section.area).epsilon(2e-3));
    // Slip: over the same r_f, without a pull to its cohesion.
    Rve sheared = pair();
    const double limit = 2 * sigma / ks, turn = limit / l0 / (1000 * step);
    move(sheared, rolling(turn), 2000);
    CHECK(sheared.network().grains[1].resultant[1] == Approx(section.area * sigma).epsilon(1e-8));  // half of 2 sigma
    move(sheared, rolling(turn), 999);
    CHECK(column_of<SofteningBond>(sheared, SofteningBond::broken) == 0);
    move(sheared, rolling(turn), 2);
    CHECK(column_of<SofteningBond>(sheared, SofteningBond::broken) == 2);
  }
}

TEST_CASE("cement of each model: the bonds that its keys say, and pairs bonded once", "[bond]") {
  const double a = 1e-3, r = 0.5 * a + 1e-8, thickness = 2e-3;
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    INFO(name(shape));
    const bool plane = dimension_of(shape) == 2;
    Specimen s = empty_specimen(shape, 4 * a, linear_material(1e4, 5e3, 0.5));
    if (plane) s.cell.lattice(2, 2) = thickness;
    for (int k = 0; k < (plane ? 1 : 4); ++k)
      for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) add_grain(s, Vector3(i, j, plane ? 0 : k) * a, r);
    protocol::Cementation cement;
    cement.young_modulus = 1e8;
    cement.shear_ratio = 0.4;
    cement.radius = 0.5;
    cement.tensile_strength = 2e5;
    cement.friction_angle_deg = 45;
    const double bond = 0.5 * r, area = plane ? 2 * bond * thickness : pi * bond * bond, stiffness = 1e8 / (2 * r);
    const std::size_t pairs = (plane ? 2 : 3) * s.grains.size();
    {
      Rve rve(s);
      cement.model = protocol::BondModel::surface;
      rve.set_interactions(protocol::cemented(rve, cement));
      const Interactions all = rve.interactions();
      CHECK(static_cast<const ListOf<SurfaceBond>&>(all).items.size() == pairs);
      CHECK(column_of<SurfaceBond>(rve, SurfaceBond::shear_factor) == Approx(1).epsilon(1e-12));
      // Stress linear over the width: bending opens the rim at M = (sigma + R_n/A) I/R.
      CHECK(column_of<SurfaceBond>(rve, SurfaceBond::bending_factor) == Approx(plane ? 1.0 / 3 : 0.25).epsilon(1e-12));
      CHECK(column_of<SurfaceBond>(rve, SurfaceBond::twisting_factor) == Approx(plane ? 0 : 0.5).epsilon(1e-12));
      cement.model = protocol::BondModel::parallel;
      cement.cohesion = 2e5;
      const Interactions more = protocol::cemented(rve, cement);
      CHECK(static_cast<const ListOf<ParallelBond>&>(more).items.empty());
    }
    Rve rve(s);
    cement.model = protocol::BondModel::contact;
    cement.cohesion = 1e5;
    rve.set_interactions(protocol::cemented(rve, cement));
    CHECK(column_of<ContactBond>(rve, ContactBond::first_gap) == Approx(-2e-8).epsilon(1e-6));
    CHECK(column_of<ContactBond>(rve, ContactBond::normal_stiffness) == Approx(stiffness * area).epsilon(1e-12));
    CHECK(column_of<ContactBond>(rve, ContactBond::shear_stiffness) == Approx(0.4 * stiffness * area).epsilon(1e-12));
    CHECK(column_of<ContactBond>(rve, ContactBond::tensile_strength) == Approx(2e5 * area).epsilon(1e-12));
    CHECK(column_of<ContactBond>(rve, ContactBond::shear_strength) == Approx(1e5 * area).epsilon(1e-12));
    CHECK(column_of<ContactBond>(rve, ContactBond::friction) == Approx(1).epsilon(1e-12));
  }
}
