// A stress held while time passes at a given rate.
#include "tests/catch.hpp"
#include "tests/extreme/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

/// Shear by dg in the xy plane with sigma_yy held at -p; the part that is lacking was missed by the increment before.
MixedTarget shear_at(double dg, double p, const Matrix3& stress, bool first) {
  MixedTarget target;
  target.spin = 0.5 * (entry(0, 1, dg) - entry(1, 0, dg));
  target.rows = {{entry(0, 0, 1), Matrix3::Zero(), 0, 0},
                 {Matrix3::Zero(), entry(1, 1, 1), -p - stress(1, 1), p},
                 {0.5 * (entry(0, 1, 1) + entry(1, 0, 1)), Matrix3::Zero(), 0.5 * dg, 0}};
  if (!first) target.rows[1].missed = target.rows[1].value;
  target.tolerance = 0.05;
  return target;
}

}  // namespace

TEST_CASE("holding a stress takes no time beyond what was given") {
  Specimen s = packed(gas(2, spread_radii(60, 0.2), 0.4, 3, material(1e6, 5e5, 0.4)), 2e3);
  s.solver.fixed_time_step = 0.5 * Rve(s).critical_time_step();
  Rve rve(s);
  Matrix3 stress = rve.stress();
  for (int k = 0; k < 20; ++k) {
    const Response response = rve.apply(shear_at(1e-3, 2e3, stress, k == 0), 33.5 * s.solver.fixed_time_step);
    CHECK(response.report.substeps == 34);
    stress = response.stress;
  }
}

TEST_CASE("dashpots do not shake a held stress") {
  // Frictional discs of restitution 0.1 at I = 0.1 and kappa = 1e4: held within 1 to 5 times its target before.
  const double p = 1e3;
  Specimen s = packed(gas(2, spread_radii(200, 0.2), 0.4, 3, material(p * 0.5 * 1e4, p * 0.5 * 5e3, 0.4)), p);
  s.damping.dashpot = Dashpot::restitution;
  s.damping.restitution = 0.1;
  s.solver.max_overlap_ratio = 0.5;
  Rve rve(s);
  const double rate = 0.1 * std::sqrt(p / 2650) / 2, dg = 5e-3;
  Matrix3 stress = rve.stress();
  double sum = 0, squares = 0, strain_error = 0;
  int count = 0;
  for (int k = 0; k < 100; ++k) {
    const Response response = rve.apply(shear_at(dg, p, stress, k == 0), dg / rate);
    stress = response.stress;
    strain_error = std::max(strain_error, std::abs(response.displacement_gradient(0, 1) - dg));
    if (k < 20) continue;
    const double held = -stress(1, 1) / p;
    sum += held;
    squares += held * held;
    ++count;
  }
  const double mean = sum / count, scatter = std::sqrt(squares / count - mean * mean);
  CAPTURE(mean, scatter);
  CHECK(strain_error < 1e-12);
  CHECK(std::abs(mean - 1) < 0.01);  // 80 increments of 200 discs: 0.003 of standard error
  CHECK(scatter < 0.05);
}
