// Hertz's radius of ellipses from their curvature at the contact (contact.hertz_radius = "curvature").
//
//   R_i = a_i^2 b_i^2/h_i^3,   h_i^2 = a_i^2 (n.e1)^2 + b_i^2 (n.e2)^2,   1/R* = 1/R_i + 1/R_j
//   f_n = 4/3 E* sqrt(R* delta) delta,   kt = 8 G* sqrt(R* delta)
//
// R_i is the radius of curvature where the tangent is normal to n: b^2/a at the tips, a^2/b on the flanks, r of a disc.
// The constants of a contact hold sqrt(r*) of r = sqrt(a b), so that sqrt(delta) is replaced by sqrt(delta R*/r*)
// wherever a law takes it: force, stiffnesses, rescaling of f_t, and dashpots, whose k or r* is then that of R*.
//
// Such a force has no energy. Its work is -int f d(delta) over the path of the grains, and a sum of that kind is the
// same for every path only if f is a function of delta alone; here d f ^ d delta = (f/2R*) dR* ^ d delta is not 0. Two
// ellipses that are pressed together at R1, turned at the same overlap to R2 and parted there give 2/5 f2 delta - 2/5
// f1 delta more than was put in. 2/5 f delta is what counts as elastic energy: the work of pressing them as they lie.
// What is made or lost as R* changes, int (f delta/5)(dR*/R*), is in no entry of the ledger: it is what remains of it.
// (Which contact forces of shapes that are not round have an energy: Feng, Han and Owen 2012, Comput. Methods Appl.
// Mech. Engrg. 205-208, 169-177.)
#pragma once

namespace rvelab {

/// R*/r*, from r = sqrt(a b) and the support h of either ellipse along the normal, m: R_i = r_i (r_i/h_i)^3.
template <class V>
static inline __attribute__((always_inline)) V hertz_radius_ratio(V ri, V hi, V rj, V hj) {
  const V qi = hi / ri, qj = hj / rj;
  return (ri + rj) / (rj * (qi * (qi * qi)) + ri * (qj * (qj * qj)));
}

}  // namespace rvelab
