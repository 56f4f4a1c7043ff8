// Grains that touch by conical asperities (Goddard 1990, Proc. R. Soc. A 430, 105-131; cone on a half-space: Sneddon
// 1965, Int. J. Engng Sci. 3, 47-57).
//
//   f_n = 2 E*/(pi s) delta^2,   kt = 8 G* a = 16 G*/(pi s) delta,   f_t <- f_t q - kt du_t
//
// a = 2 delta/(pi s) is the radius of the area of contact, d f_n/d delta = 2 E* a. s = s_i + s_j is the slope of the
// gap between two coaxial cones, s_i the tangent of the angle between the side of a cone and the tangent plane of its
// grain; E*, G* as in hertz_mindlin.hpp. kt/kn = 4 G*/E*, 2 (1 - nu)/(2 - nu) of one material: the ratio of Mindlin's
// spheres holds for every area that is round (Jaeger 1995, Arch. Appl. Mech. 65, 478-487). q = delta/delta_old where
// the overlap falls (`unload_rescale`), else 1.
//
// The stiffness of a network goes with f_n^(1/2), so with p^(1/2), and not with the radii.
#pragma once

#include "rvelab/contact/hertz_mindlin.hpp"

namespace rvelab {

struct ConesForce : LinearForce {
  static constexpr bool needs_root_overlap = true;
  static constexpr bool stores_root_overlap = true;
  using Impact = ConeImpact;

  template <class V>
  static inline __attribute__((always_inline)) V normal_force(V kn, V overlap, V /*root*/, V /*own*/) {
    return kn * (overlap * overlap);
  }
  template <class V>
  static inline __attribute__((always_inline)) V normal_stiffness(V kn, V root) {
    return 2.0 * kn * (root * root);
  }
  template <class V>
  static inline __attribute__((always_inline)) V tangential_stiffness(V kt, V root) {
    return kt * (root * root);
  }
  template <class V>
  static inline __attribute__((always_inline)) V carried(V root, V last_root, bool unload_rescale) {
    const V ratio = HertzMindlinForce::carried(root, last_root, unload_rescale);
    return ratio * ratio;
  }
  static double stiffness_growth(double overlap, double /*own*/) { return 1 / overlap; }
  static double normal_energy(double kn, double overlap, double /*root*/, double /*own*/) {
    return kn * overlap * overlap * overlap / 3;
  }
};

struct ConeSlope {
  double cone_slope = 0;  ///< > 0
  static constexpr StoredConstant<ConeSlope> stored[] = {{"cone_slope", &ConeSlope::cone_slope, "1", true}};
};

struct ConesLaw {
  static constexpr const char* name = "cones";
  using Force = ConesForce;

  template <class Each>
  static void parameters(Each each) {
    HertzMindlinLaw::parameters(each);
    each(Parameter{"cone_slope", "cone_slope", "1", positive_number,
                   "tangent of the angle between the side of a cone and the tangent plane",
                   "give the slope of the asperities, 0.1 for 6 degrees"},
         &ConeSlope::cone_slope);
  }
  template <class Material>
  static ContactConstants mix(const Material& a, double /*ri*/, const Material& b, double /*rj*/, double /*section*/) {
    constexpr double pi = 3.14159265358979323846;
    const double slope = pi * (a.cone_slope + b.cone_slope);
    return {2 / (slope * HertzMindlinLaw::compression(a, b)), 16 / (slope * HertzMindlinLaw::shear(a, b))};
  }
};

}  // namespace rvelab
