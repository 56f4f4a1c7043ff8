// Linear contact law (Liang and Zhao 2019, eq. 20-23, 26-27).
//
//   f_n = kn delta,   f_t <- f_t - kt du_t,   kn = 2 Ei ri Ej rj/(Ei ri + Ej rj),   kt the same with E nu
//
// kn, kt in N/m, delta in m. How to write the next law: linear_adhesive.hpp, which is this one and a pull-off force.
// V is a double or a vector of doubles (lanes/lanes.hpp); functions have internal linkage because every instruction set
// compiles its own copy.
#pragma once

#include "rvelab/contact/damping.hpp"
#include "rvelab/contact/impact.hpp"
#include "rvelab/contact/parameter.hpp"

namespace rvelab {

/// The forces of linear springs, for all laws whose normal force is kn delta.
struct LinearForce {
  static constexpr bool needs_root_overlap = false;
  static constexpr bool stores_root_overlap = false;
  static constexpr bool has_law_constant = false;
  static constexpr bool has_hertz_radius = false;   ///< the constants hold sqrt(r*) (hertz_curvature.hpp)
  static constexpr bool is_hertz = false;           ///< smooth spheres: JKR, DMT and LAMMPS' dashpots build on them
  static constexpr bool root_has_constant = false;  ///< `root` is not that of the overlap alone
  using Impact = LinearImpact;

  /// What the stiffnesses go with, m^0.5: sqrt(overlap) of most laws. The overlap is >= 0, `own` the law's own constant
  /// of the contact.
  template <class V>
  static inline __attribute__((always_inline)) V root(V overlap, V /*own*/) {
    return square_root(overlap);
  }
  /// Repulsion, N.
  template <class V>
  static inline __attribute__((always_inline)) V normal_force(V kn, V overlap, V /*root*/, V /*own*/) {
    return kn * overlap;
  }
  /// d f_n / d overlap, N/m.
  template <class V>
  static inline __attribute__((always_inline)) V normal_stiffness(V kn, V /*root*/) {
    return kn;
  }
  /// k_t now, N/m; k_r now follows from its constant in the same way.
  template <class V>
  static inline __attribute__((always_inline)) V tangential_stiffness(V kt, V /*root*/) {
    return kt;
  }
  /// Factor on the stored force and moment before the increment.
  template <class V>
  static inline __attribute__((always_inline)) V carried(V /*root*/, V /*last_root*/, bool /*unload_rescale*/) {
    return V{} + 1.0;
  }
  /// d ln k_t / d overlap, 1/m, of laws that carry the stored force by the stiffness.
  static double stiffness_growth(double /*overlap*/, double /*own*/) { return 0; }
  /// Dashpot coefficient now, N s/m.
  template <class V>
  static inline __attribute__((always_inline)) V dashpot(V cn, V /*overlap*/, V root, V /*own*/, int quarters) {
    return dashpot_coefficient(cn, root, quarters);
  }
  /// The force that presses the surfaces together, which friction and the rolling cap go with (coulomb.hpp), N.
  template <class V>
  static inline __attribute__((always_inline)) V pressing_force(V normal, V /*own*/) {
    return normal;
  }
  /// The work that f_n has taken up from zero overlap, J.
  static double normal_energy(double kn, double overlap, double /*root*/, double /*own*/) {
    return 0.5 * kn * overlap * overlap;
  }
};

struct YoungModulus {
  double young_modulus = 0;  ///< Pa, > 0
  static constexpr StoredConstant<YoungModulus> stored[] = {{"young_modulus_Pa", &YoungModulus::young_modulus, "Pa"}};
};
struct StiffnessRatio {
  double stiffness_ratio = 0;  ///< kt/kn, 0 to 10
  static constexpr StoredConstant<StiffnessRatio> stored[] = {
      {"stiffness_ratio", &StiffnessRatio::stiffness_ratio, "1"}};
};

struct LinearLaw {
  static constexpr const char* name = "linear";
  using Force = LinearForce;

  template <class Each>
  static void parameters(Each each) {
    each(Parameter{"young_modulus_Pa", "young_modulus", "Pa", positive_number,
                   "E of kn = 2 Ei ri Ej rj/(Ei ri + Ej rj)", "give the contact modulus E"},
         &YoungModulus::young_modulus);
    each(Parameter{"stiffness_ratio",
                   "stiffness_ratio",
                   "1",
                   {0, 10},
                   "kt/kn; 0 set by a protocol drops the tangential forces that the specimen holds",
                   "give kt/kn of the linear law"},
         &StiffnessRatio::stiffness_ratio);
  }
  /// Grains of radii ri, rj (m); `section`: cross-section of the smaller one, m^2.
  template <class Material>
  static ContactConstants mix(const Material& a, double ri, const Material& b, double rj, double /*section*/) {
    const double ei = a.young_modulus * ri, ej = b.young_modulus * rj;
    return {harmonic_mean(ei, ej), harmonic_mean(ei * a.stiffness_ratio, ej * b.stiffness_ratio)};
  }
};

}  // namespace rvelab
