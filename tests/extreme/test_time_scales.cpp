// Times far below and far beyond the critical step, fast shear, and no pressure at all.
#include <limits>

#include "tests/catch.hpp"
#include "tests/extreme/energy.hpp"
#include "tests/extreme/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

/// Frictionless, disordered, at rest under about 2e4 Pa.
Specimen resting() { return packed(gas(2, spread_radii(40, 0.3), 0.4, 31), 2e4); }

const Matrix3 deviator = Vector3(2e-4, -4e-4, 0).asDiagonal();

}  // namespace

TEST_CASE("In a time too short for any grain to move by itself the packing follows the cell", "[extreme]") {
  const Specimen start = resting();
  Specimen moved = start;
  const Matrix3 f = Matrix3::Identity() + deviator;
  moved.cell.lattice = (f * moved.cell.lattice).eval();
  for (Vector3& x : moved.grains.position) x = f * x;
  const Matrix3 expected = stress_by_hand(moved, stiffness, 1);
  const double critical = Rve(start).critical_time_step();
  for (const double part : {1e-6, 1e-9, 1e-12}) {
    Rve rve(start);
    const Response response = rve.apply(deviator, part * critical);
    CAPTURE(part, response.report.substeps);
    CHECK(largest(response.contact_stress - expected) <= 1e-9 * largest(expected));
    CHECK(largest(response.reynolds_stress) <= 1e-9 * largest(expected));
  }
}

TEST_CASE("a fast shear closes the energy balance as the step falls") {
  // What is left was 0.5 to 9 % of the work at any step while kinetic energy was counted with w' alone.
  const double rate = GENERATE(0.3, 3.0);
  Specimen s = packed(gas(2, spread_radii(60, 0.2), 0.4, 3, material(1e6, 5e5, 0.3)), 1e4);
  s.solver.energy_balance = true;
  s.solver.max_overlap_ratio = 0.9;
  s.solver.time_step_factor = 0.02;
  Rve rve(s);
  rve.apply(entry(0, 1, 0.05), 0.05 / rate);
  EnergyBalance energy(rve);
  rve.apply(entry(0, 1, 0.1), 0.1 / rate);
  energy.look();
  CAPTURE(rate);
  CHECK(energy.residual() < 3e-3);
}

TEST_CASE("Strain at no pressure has an infinite inertial number, not that of a state at rest", "[extreme]") {
  Rve gas(resting());
  const double critical = gas.critical_time_step();
  gas.apply(Vector3(0.05, 0.05, 0).asDiagonal(), 0);
  REQUIRE(gas.stress().isZero(0));
  CHECK(gas.apply(1e-6 * deviator, critical).report.inertial_number == std::numeric_limits<double>::infinity());
  CHECK(gas.apply(Matrix3::Zero(), critical).report.inertial_number == 0);
}

TEST_CASE("A given time step beyond the critical one is refused with both, the state unchanged", "[extreme]") {
  Specimen s = resting();
  // The row sums of stiffness bound the largest frequency from above, by twice at most (test_frequency_bound.cpp).
  const double critical = Rve(s).critical_time_step(), p = mean_pressure(Rve(s).stress(), 2);
  for (const double factor : {2.5, 4.0, 1e6}) {
    s.solver.fixed_time_step = factor * critical;
    Rve rve(s);
    const auto before = rve.save();
    const double dt = 1000 * s.solver.fixed_time_step;
    MixedTarget held;
    held.rows = {stress_row(0, 0, 0, p), stress_row(1, 1, 0, p), strain_row(0, 1, 0)};
    for (const std::string& text : {error_text<IncrementFailed>([&] { rve.apply(deviator, dt); }),
                                    error_text<IncrementFailed>([&] { rve.apply(held, dt); })}) {
      CHECK(contains(text, "solver.fixed_time_step_s = " + in_words(s.solver.fixed_time_step)));
      CHECK(contains(text, "above the critical step, "));
    }
    CHECK((rve.save() == before));
    rve.apply(1e-3 * deviator, 0.5 * critical);  // steps are at most as long as what is left of the increment
  }
  s.solver.fixed_time_step = 0.5 * critical;
  Rve(s).apply(1e-3 * deviator, 10 * critical);
}
