// A contact of two superellipsoids, linearised: how force and torques change with branch and rotations.
//
// With n the normal, x_i and x_j the contact point from either centre, p_i = x_i + delta/2 n and p_j = x_j - delta/2 n
// the points of both surfaces, C the tensors of their radii of curvature across n, P = I - n n and u = db + dtheta_j x
// x_j - dtheta_i x x_i the motion of the material points at the contact:
//   d delta = -n.u                                                     a turn of n changes nothing
//   (C_i + C_j - delta) dn = P (db + dtheta_j x p_j - dtheta_i x p_i) + C_i (dtheta_i x n) + C_j (dtheta_j x n)
//   d f_n   = k_n d delta
//   d f_t   = -n (f_t . dn) + 1/2 (n . (dtheta_i + dtheta_j)) n x f_t - k_t P u
//             + f_t d delta/(2 delta) where Hertz-Mindlin unloads with rescaling
//   d M     = likewise turned, - k_r P (dtheta_j - dtheta_i), rescaled as f_t
//   d x_i   = (dp_i + dp_j + db)/2,   dp_i = dtheta_i x p_i + C_i (dn - dtheta_i x n), dp_j likewise with -C_j
//   T_i     = -x_i x F - M,   T_j = x_j x F + M
// With Hertz's radius from the curvature (contact/hertz_curvature.hpp) f_n also changes by f_n dR*/(2 R*), and d delta
// in the rescaling of f_t is d delta + delta dR*/R*.
//
// (The second equation: p_i - p_j - b = delta n stays along n.) For two spheres this is contact_linear.hpp.
#pragma once

#include "rvelab/measure/contact_linear.hpp"

namespace rvelab {

/// `i`, `j`: grains of a network of superellipsoids, `axes`: those of their shapes, cell frame.
LinearOutlineContact linearised_solids(const ContactState& contact, const GrainState& i, const Matrix3& axes_i,
                                       const GrainState& j, const Matrix3& axes_j,
                                       HertzRadius hertz_radius = HertzRadius::equivalent);

}  // namespace rvelab
