// Specimens that experiments start from, made in code: jammed grains at a given stiffness level, and the comparison of
// a run at the solver's own pace with a well-resolved one.
#pragma once

#include "rvelab/solver/rve.hpp"
#include "rvelab/stress_test/specimens.hpp"
#include "rvelab/stress_test/verdict.hpp"

namespace rvelab::stress_test {

/// Pressure at which linear springs of `stiffness` between grains of radius 1 have the stiffness level kappa:
/// kn/(p thickness) in 2D (thickness 0.5 m), kn/(p d) in 3D. Pa.
double pressure_at(int dimension, double kappa);
/// The same of any specimen of grains of radius near 1, (E*/p)^(2/3) for Hertz contacts.
double pressure_of_level(const Specimen& specimen, double kappa);

/// Jammed grains of radii within 30 % of 1 at rest under an isotropic pressure (Pa), packed without friction in the
/// cell of `loose`; the friction of the materials acts from there on, no history yet.
Specimen jammed(const Specimen& loose, double pressure);

/// The same from scratch: linear springs, `count` grains; ellipses where the aspect ratio is below 1.
Specimen jammed_linear(int dimension, int count, double kappa, double kt_over_kn, double friction,
                       double aspect_ratio = 1);

/// Hertz-Mindlin contacts of grains of radius near 1.
Specimen jammed_hertz(int dimension, int count, double young_modulus, double poisson_ratio, double friction,
                      double pressure);

/// Either, of 64 discs (ellipses: linear springs) or spheres, as most experiments want them; 100 kPa in Hertz contacts
/// of 1 GPa.
Specimen usual(int dimension, bool hertz, double friction = 0.5, double aspect_ratio = 1);

/// Biaxial compression along y, or simple shear v_x(y); dH of unit size.
Matrix3 biaxial_direction(int dimension);
Matrix3 shear_direction(int dimension);

/// A path at the solver's own pace against the same with so many fixed sub-steps an increment.
struct Path {
  Matrix3 direction;
  double strain = 1e-3;
  int increments = 10;
  long resolved = 10'000;
};

/// From rest, the stress at the end of the path: |sigma - resolved| <= p max(tolerance, 2 tolerance times the change of
/// stress over p). The resolved run must itself agree with one of 0.4 times its sub-steps to a third of that.
void compare_with_resolved(const Specimen& start, const Path& path, double tolerance, Verdict& verdict);

}  // namespace rvelab::stress_test
