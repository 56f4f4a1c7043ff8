// Increments of quasi-static loading in which bonds break, bridges rupture or form: what the estimate says of them
// against the same increment in very fine sub-steps.
#include <algorithm>

#include "tests/interaction/bonded.hpp"
#include "tests/solver/resolved.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

constexpr double row_spacing = 0.01;

/// A straight row of grains across a cell, each bonded to the next; one bond has this part of the strength of the
/// others. Along the row the stress is that of one bond, and goes as the weakest breaks.
Rve row_of_grains(Shape shape, double strength, double weakest) {
  const int number = 6;
  Specimen s = empty_specimen(shape, number * row_spacing, linear_material(2e6, 1e6, 0.3));
  for (int k = 0; k < number; ++k) add_grain(s, Vector3(k * row_spacing, 0.2 * row_spacing, 0), 0.49 * row_spacing);
  Rve rve(s);
  Interactions all = protocol::cemented(rve, cement_of(strength));
  REQUIRE(bonds_of(all).size() == std::size_t(number));
  double columns[interaction_columns<ParallelBond>()];
  put_columns<ParallelBond>(bonds_of(all)[2], columns);
  columns[ParallelBond::tensile_strength] *= weakest;
  take_columns<ParallelBond>(columns, bonds_of(all)[2]);
  rve.set_interactions(all);
  return rve;
}

Rve packing_of_strength(Shape shape, double strength) {
  Rve rve = small_packing_at_rest(shape, 0.4);
  protocol::Cementation cement = cement_of(strength, 0);
  cement.strength_scatter = strength < 1e30 ? 0.3 : 0;
  rve.set_interactions(protocol::cemented(rve, cement));
  return rve;
}

std::size_t broken_bonds_of(const Rve& rve) {
  const auto bonds = bonds_of(rve);
  return std::size_t(
      std::count_if(bonds.begin(), bonds.end(), [](const Bond& b) { return column(b, ParallelBond::broken) > 0; }));
}

}  // namespace

TEST_CASE("grains pulled apart through breaking in one long increment lose their stress, within the estimate",
          "[breaking]") {
  // kn = E/2r over the section, elongation a eps of a bond, a = 2r/0.98: stress E eps/0.98 in the section.
  const double strength = 2e5, weakest = 0.8, breaks_at = 0.98 * weakest * strength / 1e8;
  for (const Shape shape : {Shape::disc, Shape::sphere})
    for (const double part : {0.5, 0.9, 1.1, 1.5, 4.0}) {
      INFO(name(shape) << ", strain over that of breaking " << part);
      const Rve start = row_of_grains(shape, strength, weakest);
      const Matrix3 pull = gradient(part * breaks_at, 0, 0, 0);
      Rve rve(start);
      const Response made = rve.apply(pull, 0);
      const Matrix3 truth = resolved_stress(start.specimen(), pull);
      CHECK(broken_bonds_of(rve) == (part > 1 ? 1 : 0));
      const double face = 6 * row_spacing * (shape == Shape::disc ? 1 : 6 * row_spacing),
                   peak = weakest * strength * section_of(shape, 0.49 * row_spacing).area / face;
      CHECK(truth.norm() == Approx(part > 1 ? 0 : part * peak).margin(0.01 * peak));
      CHECK((made.stress - truth).norm() <= made.report.error_estimate);
      CHECK(made.report.error_estimate < (part > 1 ? 3 : 0.1) * peak);
    }
}

TEST_CASE("a cemented specimen in tension is judged by the forces that it bears, not as a gas", "[breaking]") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    INFO(name(shape));
    Rve rve = packing_of_strength(shape, 1e30);
    rve.apply(gradient(3e-2, 0, 0, 3e-2), 0);
    REQUIRE(rve.relax(1e-8, 200'000).target_held);
    REQUIRE(pressure(rve.stress(), 2) < 0);
    for (const double length : {1e-6, 1e-5, 1e-4, 1e-3}) {
      CAPTURE(length);
      const Matrix3 step = length * biaxial_step, truth = resolved_stress(rve.specimen(), step, 2000);
      Rve made(rve);
      const Response r = made.apply(step, 0);
      CHECK((r.stress - truth).norm() <= r.report.error_estimate);
      CHECK(r.report.error_estimate < 0.2 * (truth - rve.stress()).norm() + 1e-3 * truth.norm());
    }
  }
}

TEST_CASE("at the peak of a cemented packing the estimate covers what breaking leaves open", "[breaking]") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    INFO(name(shape));
    Rve rve = packing_of_strength(shape, 3e5);
    while (broken_bonds_of(rve) < 3) rve.apply(2e-4 * shear_step, 0);
    int within = 0, all = 0;
    for (const double length : {5e-5, 2e-4, 5e-4, 1e-3})
      for (const Matrix3& way : {shear_step, biaxial_step}) {
        CAPTURE(length, all);
        Rve made(rve);
        const Network before = made.network();
        const Response r = made.apply(length * way, 0);
        within += (r.stress - resolved_stress(rve.specimen(), length * way)).norm() <= r.report.error_estimate;
        ++all;
        // By the forces that the bonds bore before: they grew until they broke.
        double squares = 0;
        const Network after = made.network();
        for (const InteractionState& bond : before.interactions) {
          const bool intact = std::any_of(after.interactions.begin(), after.interactions.end(),
                                          [&](const auto& other) { return other.i == bond.i && other.j == bond.j; });
          if (!intact) squares += std::pow(bond.force().norm() * bond.branch.norm() / after.cell.volume(), 2);
        }
        CHECK(r.report.error_estimate >= std::sqrt(squares));
      }
    CHECK(within >= all - 1);
    CHECK(broken_bonds_of(rve) > 0);
  }
}

TEST_CASE("a bridge that ruptures within an increment takes its pull with it, within the estimate", "[breaking]") {
  const int number = 6;
  Specimen s = empty_specimen(Shape::sphere, number * row_spacing, linear_material(2e3, 1e3, 0.3));
  for (int k = 0; k < number; ++k) add_grain(s, Vector3(k * row_spacing, 0, 0), 0.5005 * row_spacing);
  Rve start(s);
  Water water;
  water.volume_ratio = 1e-3;
  set_settings<CapillaryBridge>(start, {water});
  REQUIRE(start.interactions().ListOf<CapillaryBridge>::items.size() == std::size_t(number));
  // The overlaps are 1e-3 of the row_spacing, the rupture gap is some 5e-2 of it: one of six opens by all of the
  // strain.
  for (const double strain : {5e-4, 5e-3, 2e-2}) {
    CAPTURE(strain);
    const Matrix3 pull = gradient(strain, 0, 0, 0), truth = resolved_stress(start.specimen(), pull);
    Rve rve(start);
    const Response made = rve.apply(pull, 0);
    const std::size_t left = rve.interactions().ListOf<CapillaryBridge>::items.size();
    CHECK(left == std::size_t(strain > 1e-2 ? number - 1 : number));
    CHECK((truth.norm() < 1e-6 * start.stress().norm()) == (strain > 1e-2));
    CHECK((made.stress - truth).norm() <= made.report.error_estimate);
  }
}

TEST_CASE("an increment in which bonds break is the same as a trial, after a restart and of a copy", "[breaking]") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    INFO(name(shape));
    Rve rve = packing_of_strength(shape, 3e5);
    for (int k = 0; k < 6; ++k) {
      Rve tried(rve), restarted(rve.specimen()), read(rve);
      read.restore(rve.save());
      const Response made = rve.apply(1e-3 * shear_step, 0), trial = tried.attempt(1e-3 * shear_step, 0);
      tried.commit();
      for (const Response& other : {trial, restarted.apply(1e-3 * shear_step, 0), read.apply(1e-3 * shear_step, 0)}) {
        CHECK(same_bits(other.stress, made.stress));
        CHECK(other.report.error_estimate == made.report.error_estimate);
        CHECK(other.report.substeps == made.report.substeps);
      }
      CHECK(tried.save() == rve.save());
      CHECK(restarted.save() == rve.save());
    }
    CHECK(broken_bonds_of(rve) > 0);
  }
}
