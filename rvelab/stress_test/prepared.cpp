#include "rvelab/stress_test/prepared.hpp"

#include <algorithm>
#include <cmath>

#include "rvelab/measure/measures.hpp"
#include "rvelab/pack/consolidation.hpp"
#include "rvelab/stress_test/tested.hpp"

namespace rvelab::stress_test {

double pressure_at(int dimension, double kappa) { return stiffness / (kappa * (dimension == 2 ? 0.5 : 2.0)); }

Specimen jammed(const Specimen& loose, double pressure) {
  Specimen s = loose;
  for (Material& m : s.materials) m.friction = 0;
  s.state = {};
  Rve rve(packed(s, pressure, 1e-5));
  StressGoal goal;
  goal.dimension = s.cell.dimension;
  goal.shear = false;
  goal.stress = isotropic(s.cell.dimension, -pressure);
  if (!consolidate(rve, goal, {.stress_tolerance = 1e-2, .unbalanced = 1e-7, .largest_change = 0.3}))
    throw Error("the packing did not come to its pressure");
  rve.relax(1e-10, 100'000);
  rve.zero_velocities();
  rve.set_materials(loose.materials);
  Specimen result = rve.specimen();
  result.solver = loose.solver;
  result.damping = loose.damping;
  result.state = {};
  return result;
}

Specimen jammed_linear(int dimension, int count, double kappa, double kt_over_kn, double friction) {
  const Material grain = material(stiffness, kt_over_kn * stiffness, friction);
  Specimen loose = gas(dimension, spread_radii(count, 0.3), dimension == 2 ? 0.4 : 0.25, 5, grain);
  if (kappa < 100) loose.solver.max_overlap_ratio = 0.9;  // as soft as that, grains overlap by tenths of their radii
  return jammed(loose, pressure_at(dimension, kappa));
}

Specimen jammed_hertz(int dimension, int count, double young_modulus, double poisson_ratio, double friction,
                      double pressure) {
  Material grain;
  grain.young_modulus = young_modulus;
  grain.poisson_ratio = poisson_ratio;
  grain.friction = friction;
  Specimen loose = gas(dimension, spread_radii(count, 0.3), dimension == 2 ? 0.4 : 0.25, 5, grain);
  loose.contact.law = Law::hertz_mindlin;
  return jammed(loose, pressure);
}

Specimen usual(int dimension, bool hertz, double friction) {
  return hertz ? jammed_hertz(dimension, 64, 1e9, 0.2, friction, 1e5)
               : jammed_linear(dimension, 64, 1e3, 0.5, friction);
}

Matrix3 biaxial_direction(int dimension) {
  return dimension == 2 ? Matrix3(entry(0, 0, 0.5) + entry(1, 1, -1))
                        : Matrix3(entry(0, 0, 0.5) + entry(1, 1, 0.25) + entry(2, 2, -1));
}

Matrix3 shear_direction(int dimension) { return entry(0, dimension - 1, 1); }

void compare_with_resolved(const Specimen& specimen, const Path& path, double tolerance, Verdict& verdict) {
  Rve resting(specimen);
  resting.relax(1e-9, 300'000);
  resting.zero_velocities();
  const Specimen start = resting.specimen();
  const int d = start.cell.dimension;
  const Matrix3 first = resting.stress();
  const double p = mean_pressure(first, d);
  const Matrix3 increment = path.direction * (path.strain / path.increments);
  const auto resolved = [&](long substeps) {
    Specimen s = start;
    s.solver.fixed_substeps = substeps;
    Rve rve(s);
    for (int k = 0; k < path.increments; ++k) rve.apply(increment, 0);
    return rve.stress();
  };
  Tested tested(start, verdict);
  for (int k = 0; k < path.increments; ++k) {
    tested.apply(increment, 0);
    tested.check_laws();
  }
  const Matrix3 fine = resolved(path.resolved), coarser = resolved(path.resolved * 2 / 5);
  const double change = (fine - first).norm() / p;
  const double allowed = tolerance * std::max(1.0, 2 * change);
  verdict.law("the resolved run is resolved, of p", (fine - coarser).norm() / p, allowed / 3);
  verdict.agreement("stress against the resolved run, of p", (tested.rve().stress() - fine).norm() / p, allowed);
}

}  // namespace rvelab::stress_test
