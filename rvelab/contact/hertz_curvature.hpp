// Hertz's radius from the curvature at the contact (contact.hertz_radius = "curvature"), of ellipses:
//
//   R_i = a_i^2 b_i^2/h_i^3,   h_i^2 = a_i^2 (n.e1)^2 + b_i^2 (n.e2)^2,   1/R* = 1/R_i + 1/R_j
//   f_n = 4/3 E* sqrt(R* delta) delta,   kt = 8 G* sqrt(R* delta)
//
// of superellipsoids R* = 1/sqrt(k' k''), k the principal values of the summed curvatures (superellipsoid/support.hpp).
//
// R_i is the radius of curvature where the tangent is normal to n: b^2/a at the tips, a^2/b on the flanks, r of a disc.
// The constants of a contact hold sqrt(r*) of r = sqrt(a b), so that sqrt(delta) is replaced by sqrt(delta R*/r*)
// wherever a law takes it: force, stiffnesses, rescaling of f_t, and dashpots, whose k or r* is then that of R*.
//
// Such a force has no energy. 2/5 f delta, the work of pressing two grains as they lie, is what counts as elastic
// energy, and what is made or lost as R* changes is the residual of the energy balance (README.md: Hertz's radius).
#pragma once

namespace rvelab {

/// R*/r*, from r = sqrt(a b) and the support h of either ellipse along the normal, m: R_i = r_i (r_i/h_i)^3.
template <class V>
static inline __attribute__((always_inline)) V hertz_radius_ratio(V ri, V hi, V rj, V hj) {
  const V qi = hi / ri, qj = hj / rj;
  return (ri + rj) / (rj * (qi * (qi * qi)) + ri * (qj * (qj * qj)));
}

/// The same from R*.
template <class V>
static inline __attribute__((always_inline)) V radius_ratio_of(V radius, V ri, V rj) {
  return radius * ((ri + rj) / (ri * rj));
}

}  // namespace rvelab
