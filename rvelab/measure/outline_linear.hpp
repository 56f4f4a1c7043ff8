// One contact of two grains that are not round, linearised: as contact_linear.hpp, where the normal turns with the
// grains too.
//
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

#include "rvelab/measure/contact_linear.hpp"

namespace rvelab {

struct LinearOutlineContact {
  LinearContact law;        ///< without rescaling on unloading
  LinearContact unloading;  ///< what that adds where the overlap falls
  ContactRow opening;       ///< -d delta; with the radius of curvature -(d delta + delta dR*/R*)
};

LinearOutlineContact linearised_outlines(Shape shape, const ContactState& contact, const GrainState& i,
                                         const GrainState& j, HertzRadius hertz_radius = HertzRadius::equivalent);

}  // namespace rvelab
