// Far: shear to ten thousand, stretch by e^10, compression until it is refused, expansion to a gas. Frictionless
// grains, so that the stress is known from their places at any moment.
#include <algorithm>
#include <cmath>

#include "rvelab/error.hpp"
#include "rvelab/grains/uniform.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/pack/scatter.hpp"
#include "tests/extreme/matrix.hpp"
#include "tests/extreme/specimens.hpp"

namespace rvelab::test {

namespace {

/// Soft, frictionless, few enough that a far way is a short run.
Specimen soft(const Cell& cell, int count, int dimension) {
  const std::vector<double> radii = spread_radii(count, 0.2);
  Specimen s = specimen_of(cell, std::vector<Vector3>(radii.size(), Vector3::Zero()), radii);
  Uniform uniform(3);
  if (!pack::scatter(s.shape, cell, 1.0, s.grains, uniform)) throw Error("no free place is left for a grain");
  s.solver.min_height = 0.5;
  s.solver.max_overlap_ratio = 0.9;
  return jammed(s, pressure_at(dimension, 50));
}

Cell cell_for(int count, int dimension, bool oriented) {
  double solid = 0;
  for (const double r : spread_radii(count, 0.2))
    solid += grain_volume(dimension == 2 ? Shape::disc : Shape::sphere, r, 0.5);
  const double volume = solid / (dimension == 2 ? 0.4 : 0.25);
  if (!oriented) return cubic_cell(dimension, volume, 0.5);
  return dimension == 2 ? kraynik_reinelt_cell(volume, 0.5) : cubic_field_cell(volume);
}

/// `total` times the same increment; laws and stress are looked at twenty times on the way.
void go(Tested& tested, const Matrix3& increment, long total, double tolerance, Verdict& verdict) {
  const long look_every = std::max(1L, total / 20);
  for (long k = 1; k <= total; ++k) {
    tested.apply(increment, 0);
    if (k % look_every != 0) continue;
    tested.check_laws();
    compare_with_images(tested.rve(), 4, tolerance, verdict);
  }
}

void sheared_far(const Case& asked, Verdict& verdict) {
  const int d = int(asked("dimension"));
  Specimen s = soft(cell_for(4, d, false), 4, d);
  s.solver.fixed_substeps = long(asked("substeps"));
  Tested tested(s, verdict);
  const double increment = asked("increment");
  go(tested, increment * shear_direction(d), std::lround(asked("gamma") / increment), asked.tolerance, verdict);
}

void stretched_far(const Case& asked, Verdict& verdict) {
  const int d = int(asked("dimension")), count = int(asked("grains"));
  Specimen s = soft(cell_for(count, d, asked("oriented") != 0), count, d);
  s.solver.min_height = 0;  // the default limit, two radii
  s.solver.fixed_substeps = long(asked("substeps"));
  Tested tested(s, verdict);
  // Isochoric: x shrinks and y grows in 2D; z grows and the others shrink in 3D.
  const double h = 0.01;
  Matrix3 increment = Matrix3::Zero();
  if (d == 2)
    increment.diagonal() << std::expm1(-h), std::expm1(h), 0;
  else
    increment.diagonal() << std::expm1(-0.5 * h), std::expm1(-0.5 * h), std::expm1(h);
  go(tested, increment, std::lround(asked("hencky") / h), asked.tolerance, verdict);
}

void compressed_until_refused(const Case& asked, Verdict& verdict) {
  const int d = int(asked("dimension"));
  Tested tested(usual(d, asked("hertz") != 0), verdict);
  const double strain = 0.01;
  const double dt = asked("rate") > 0 ? strain / (asked("rate") / tested.rve().critical_time_step()) : 0;
  std::optional<Refused> refusal;
  int made = 0;
  for (; made * strain < 1 && !refusal; ++made) {
    refusal = refused(tested.rve(), [&](Rve& rve) { rve.apply(isotropic(d, -strain), dt); });
    const double overlap = largest_overlap_ratio(tested.rve().network());
    verdict.law("overlap within the limit", overlap, tested.rve().specimen().solver.max_overlap_ratio);
  }
  verdict.refusal("compression without end", refusal);
}

void gas_and_back(const Case& asked, Verdict& verdict) {
  const int d = int(asked("dimension")), increments = 50;
  Tested tested(jammed_linear(d, 64, asked("kappa"), 0.5, 0), verdict);
  const double expansion = asked("expansion"), before = tested.pressure();
  tested.apply(isotropic(d, expansion), 0);
  verdict.law("a gas carries nothing, of p", std::abs(tested.pressure()) / before, 1e-3);
  double size = 1 + expansion;
  for (int k = 1; k <= increments; ++k) {
    const double next = 1 + expansion * (1 - double(k) / increments);
    tested.apply(isotropic(d, next / size - 1), 0);
    size = next;
    tested.check_laws();
  }
  compare_with_images(tested.rve(), 4, 1e-10, verdict);
  // Packed anew by another way, frictionless grains are about as dense; a network pressed in wrong increments is not.
  // 64 of them scatter by less than a percent in the volume at which they jam, and p/(kn/t) is the strain beyond it.
  tested.rve().relax(1e-6, 1'000'000);
  verdict.agreement("excess pressure after the way back, as a strain",
                    std::max(0.0, tested.pressure() / before - 1) / asked("kappa"), asked.tolerance);
}

void one_large_increment(const Case& asked, Verdict& verdict) {
  const int d = int(asked("dimension"));
  const double friction = asked("friction");
  Tested tested(jammed_linear(d, int(asked("grains")), asked("kappa"), 0.5, friction), verdict);
  if (friction > 0) tested.apply(1e-3 * shear_direction(d), 0);  // slip in the history
  const Matrix3 increment =
      asked("shear") * shear_direction(d) + isotropic(d, asked("expansion")) - isotropic(d, asked("compression"));
  if (asked("compression") > 0) {
    const auto refusal = refused(tested.rve(), [&](Rve& rve) { rve.apply(increment, asked("dt")); });
    return verdict.refusal("compression far beyond the overlap limit", refusal);
  }
  const Response response = tested.apply(increment, asked("dt"));
  tested.check_laws();
  if (friction == 0) return compare_with_images(tested.rve(), 4, asked.tolerance, verdict);
  bool coulomb = true;
  for (const ContactState& c : tested.rve().network().contacts)
    coulomb = coulomb && c.tangential_force.norm() <= c.friction * c.normal_force * (1 + 1e-12);
  verdict.law("|f_t| <= mu f_n", coulomb);
  verdict.law("grains do not pull", tested.pressure() >= 0);
  const double p = std::max(tested.pressure(), 1e-3 * tested.rve().reference_pressure());
  verdict.law("torques balance as forces do", largest(response.stress - response.stress.transpose()),
              response.report.unbalanced_ratio * p);
}

}  // namespace

std::vector<Experiment> deformation_experiments() {
  return {{"deformation/shear", sheared_far, "dimension 2, gamma 100, increment 0.1, substeps 0"},
          {"deformation/stretch", stretched_far, "dimension 2, grains 32, hencky 10, oriented 1, substeps 0"},
          {"deformation/compression", compressed_until_refused, "dimension 2, hertz 0, rate 0"},
          {"deformation/gas_and_back", gas_and_back, "dimension 2, kappa 1e3, expansion 0.3"},
          {"deformation/one_increment", one_large_increment,
           "dimension 2, grains 64, kappa 100, friction 0, dt 0, compression 0, shear 0.5, expansion 0"}};
}

}  // namespace rvelab::test
