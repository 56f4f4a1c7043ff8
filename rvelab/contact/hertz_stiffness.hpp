// Hertz contacts with given constants (Qu, Feng and Wang, eq. 16-17).
//
//   f_n = k delta^(3/2) (k in N/m^1.5),   f_t <- f_t - kt du_t (kt in N/m)
//
// delta^(3/2) = delta sqrt(delta): no libm in what touches state.
#pragma once

#include "rvelab/contact/linear_stiffness.hpp"

namespace rvelab {

struct HertzStiffnessForce : LinearForce {
  static constexpr bool needs_root_overlap = true;
  static constexpr bool is_hertz = true;
  using Impact = HertzImpact;

  template <class V>
  static inline __attribute__((always_inline)) V normal_force(V kn, V overlap, V root, V /*law_constant*/) {
    return kn * (overlap * root);
  }
  template <class V>
  static inline __attribute__((always_inline)) V normal_stiffness(V kn, V root) {
    return 1.5 * kn * root;
  }
  static double normal_energy(double kn, double overlap, double root, double /*law_constant*/) {
    return 0.4 * kn * overlap * overlap * root;
  }
};

struct HertzStiffnessLaw : StiffnessLaw {
  static constexpr const char* name = "hertz_stiffness";
  using Force = HertzStiffnessForce;

  template <class Each>
  static void parameters(Each each) {
    StiffnessLaw::parameters(each, {"normal_stiffness_N_m1_5", "normal_stiffness", "N/m^1.5", positive_number,
                                    "k of f_n = k overlap^1.5", "give the normal stiffness of a contact"});
  }
};

}  // namespace rvelab
