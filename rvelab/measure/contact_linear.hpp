// One contact, linearised: how force and torques of the incremental contact law change with branch and rotations.
//
// With b the branch, l its length, n = b/l, R = ri + rj, overlap delta = R - l, F = f_n n + f_t the force on j and M
// the rolling moment on j (arms of slip: contact/README.md; conventions of Rve):
//   dn    = (I - n n) db/l,   dl = n . db,   d delta = -dl
//   d f_n = -k_n dl
//   d f_t = -n (f_t . dn) + 1/2 (n . (dtheta_i + dtheta_j)) n x f_t        turned with normal and mean spin
//           - k_t (I - n n) (s db - c_j dtheta_j x n - c_i dtheta_i x n)   stuck
//           - f_t dl/(2 delta) where the law unloads with rescaling (Hertz-Mindlin)
//   d M   = likewise turned, - k_r (I - n n)(dtheta_j - dtheta_i), rescaled as f_t
//   T_i   = -a_i n x f_t - M,  T_j = -a_j n x f_t + M,  a = r - delta/2
// Slip `consistent`: s = 1, c = a; `full_radius`: s = 1, c = r, no turning by the mean spin; `full_radius_ratcheting`:
// s = R/l, c = r. In 2D the same formulas hold with rotations and moments along z.
//
// For two grains that are not round the normal also rotates with the grains.
// h_i(n) is the support of a grain about its centre, h' and h'' = rho - h its derivatives along the circle of
// directions, rho the radius of curvature at the support point (of ellipses a^2 b^2/h^3; Bend in
// grains/description.hpp); n is where f = h_i + h_j - n.b is least, and t = (-n_y, n_x). With dphi the turn of n:
//   d delta = -n.db - h_i' dtheta_i - h_j' dtheta_j                        f' = 0: a turn of n changes nothing
//   dphi    = (t.db + h_i'' dtheta_i + h_j'' dtheta_j)/(rho_i + rho_j - delta)   f' stays 0
//   d f_n   = k_n d delta
//   d T     = -k_t (t.db - (h_i - delta/2) dtheta_i - (h_j - delta/2) dtheta_j)   f_t = T t
//             + T d delta/(2 delta) where Hertz-Mindlin unloads with rescaling
//   d M     = -k_r (dtheta_j - dtheta_i), rescaled as f_t
//   d F     = (d f_n - T dphi) n + (d T + f_n dphi) t
//   T_i = -r_i x F - M, T_j = r_j x F + M, with the arms r_i = (h_i - delta/2) n + h_i' t, r_j = r_i - b
// The stiffness of a Hertz contact is that of r = sqrt(a b), which does not change as the grains turn. With the radius
// of curvature (contact/hertz_curvature.hpp) f_n and the root that f_t is rescaled by change with it too:
//   d f_n   = k_n d delta + f_n/2 dR*/R*,   T (d delta/(2 delta) + dR*/(2 R*)) where that falls
//   dR*/R*  = -3 R* (h_i'/h_i (dphi - dtheta_i)/rho_i + h_j'/h_j (dphi - dtheta_j)/rho_j)
// and the stiffness is not symmetric.
#pragma once

#include <Eigen/Geometry>

#include "rvelab/solver/assembly/network.hpp"

namespace rvelab {

using ContactMatrix = Eigen::Matrix<double, 3, 9>;
using ContactRow = Eigen::Matrix<double, 1, 9>;

/// Columns: db (3), dtheta_i (3), dtheta_j (3). Rows as named.
struct LinearContact {
  ContactMatrix force;     ///< dF on j, N/m and N
  ContactMatrix torque_i;  ///< dT on i, N and N m
  ContactMatrix torque_j;  ///< dT on j
};

/// The law without rescaling on unloading.
LinearContact linearised(const ContactState& contact, double ri, double rj, Slip slip);

/// Of an interaction other than a contact between round grains: its twisting moment follows the normal.
LinearContact linearised(const InteractionState& interaction, double ri, double rj);

/// True where the law of the network makes f_t and M fall with sqrt(overlap): it keeps that root from step to step.
bool rescales(const Network& network);

/// The radius in the constants of the law; `equivalent`, which is independent of rotations, for laws without one.
HertzRadius hertz_radius(const Network& network);

/// Terms that unloading adds to `linearised` for dl > 0: only in dl.
LinearContact unloading_terms(const ContactState& contact, double ri, double rj);

struct LinearOutlineContact {
  LinearContact law;        ///< without rescaling on unloading
  LinearContact unloading;  ///< terms of rescaling, for a decreasing overlap
  ContactRow opening;       ///< -d delta; with the radius of curvature -(d delta + delta dR*/R*)
};

LinearOutlineContact linearised_outlines(Shape shape, const ContactState& contact, const GrainState& i,
                                         const GrainState& j, HertzRadius hertz_radius = HertzRadius::equivalent);

}  // namespace rvelab
