// Linear contacts with a pull-off force: grains that stick, as moist or cemented soils do.
//
//   f_n = kn delta - c for delta > 0, else 0;   f_t <- f_t - kt du_t,   |f_t| <= mu (f_n + c)
//
// kn and kt as in linear.hpp. c is the force that parts two grains, N: the harmonic mean of what each material gives,
// pull_off_force + adhesion_pressure times the cross-section of the smaller grain (disc 2 r thickness, sphere pi r^2).
// At rest without load delta = c/kn. Friction and the rolling cap go with kn delta = f_n + c, what presses the surfaces
// together, so that a specimen shows the cohesion (mean-field: c tan(phi) times contacts and branches, Richefeu, El
// Youssoufi and Radjai 2006, Phys. Rev. E 73, 051304). An adhesion without reach: contacts that open are free at once.
#pragma once

#include "rvelab/contact/linear.hpp"

namespace rvelab {

struct LinearAdhesiveForce : LinearForce {
  static constexpr bool has_law_constant = true;  ///< c, N

  template <class V>
  static inline __attribute__((always_inline)) V normal_force(V kn, V overlap, V /*root*/, V law_constant) {
    return kn * overlap - law_constant;
  }
  template <class V>
  static inline __attribute__((always_inline)) V pressing_force(V normal, V law_constant) {
    return normal + law_constant;
  }
  static double normal_energy(double kn, double overlap, double /*root*/, double law_constant) {
    return 0.5 * kn * overlap * overlap - law_constant * overlap;
  }
};

struct Adhesion {
  double adhesion_pressure = 0;  ///< Pa, >= 0
  double pull_off_force = 0;     ///< N, >= 0
  static constexpr StoredConstant<Adhesion> stored[] = {{"adhesion_Pa", &Adhesion::adhesion_pressure, "Pa"},
                                                        {"adhesion_N", &Adhesion::pull_off_force, "N"}};
};

struct LinearAdhesiveLaw {
  static constexpr const char* name = "linear_adhesive";
  using Force = LinearAdhesiveForce;

  template <class Each>
  static void parameters(Each each) {
    LinearLaw::parameters(each);
    each(Parameter{"adhesion_Pa", "adhesion_pressure", "Pa", number_from_zero,
                   "pull-off force over the cross-section of the smaller grain", "give the adhesion, 0 for none"},
         &Adhesion::adhesion_pressure);
    each(Parameter{"adhesion_N", "pull_off_force", "N", number_from_zero, "pull-off force, beside that of adhesion_Pa",
                   "give the pull-off force, 0 for none"},
         &Adhesion::pull_off_force);
  }
  template <class Material>
  static ContactConstants mix(const Material& a, double ri, const Material& b, double rj, double section) {
    ContactConstants constants = LinearLaw::mix(a, ri, b, rj, section);
    const auto pull_off = [&](const Material& m) { return m.pull_off_force + m.adhesion_pressure * section; };
    constants.law_constant = harmonic_mean(pull_off(a), pull_off(b));
    return constants;
  }
};

}  // namespace rvelab
