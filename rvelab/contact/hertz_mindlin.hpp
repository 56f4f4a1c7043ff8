// Hertz-Mindlin contacts (Li et al. 2023, eq. 18-21).
//
//   f_n = 4/3 E* sqrt(r* delta) delta,   kt = 8 G* sqrt(r* delta),   f_t <- f_t s - kt du_t
//
// 1/E* = sum (1 - nu^2)/E, 1/G* = sum 2 (2 - nu)(1 + nu)/E, 1/r* = 1/ri + 1/rj. s = sqrt(delta/delta_old) where the
// overlap falls (`unload_rescale`; without it energy is made on unloading), else 1. The constants of a contact are what
// stands before delta^(3/2) and sqrt(delta). r is the radius of a grain, of ellipses sqrt(a b) or that of their
// curvature at the contact (hertz_curvature.hpp).
#pragma once

#include "rvelab/contact/hertz_stiffness.hpp"

namespace rvelab {

struct HertzMindlinForce : HertzStiffnessForce {
  static constexpr bool stores_root_overlap = true;
  static constexpr bool has_hertz_radius = true;

  template <class V>
  static inline __attribute__((always_inline)) V tangential_stiffness(V kt, V root) {
    return kt * root;
  }
  template <class V>
  static inline __attribute__((always_inline)) V carried(V root, V last_root, bool unload_rescale) {
    const V one = V{} + 1.0;
    if (!unload_rescale) return one;
    const V ratio = root / ((last_root > 0.0) ? last_root : one);
    return ((last_root > 0.0) & (root < last_root)) ? ratio : one;
  }
  static double stiffness_growth(double overlap, double /*own*/) { return 0.5 / overlap; }
};

struct PoissonRatio {
  double poisson_ratio = 0;  ///< -0.99 to 0.5
  static constexpr StoredConstant<PoissonRatio> stored[] = {{"poisson_ratio", &PoissonRatio::poisson_ratio, "1"}};
};

struct HertzMindlinLaw {
  static constexpr const char* name = "hertz_mindlin";
  using Force = HertzMindlinForce;

  template <class Each>
  static void parameters(Each each) {
    each(Parameter{"young_modulus_Pa", "young_modulus", "Pa", positive_number, "Young's modulus",
                   "give the contact modulus E"},
         &YoungModulus::young_modulus);
    each(Parameter{"poisson_ratio",
                   "poisson_ratio",
                   "1",
                   {-0.99, 0.5},
                   "Poisson's ratio",
                   "give Poisson's ratio of the grains, 0.25 for quartz"},
         &PoissonRatio::poisson_ratio);
  }
  /// 1/E* and 1/G*, 1/Pa.
  template <class Material>
  static double compression(const Material& a, const Material& b) {
    const auto of = [](const Material& m) { return (1 - m.poisson_ratio * m.poisson_ratio) / m.young_modulus; };
    return of(a) + of(b);
  }
  template <class Material>
  static double shear(const Material& a, const Material& b) {
    const auto of = [](const Material& m) {
      return 2 * (2 - m.poisson_ratio) * (1 + m.poisson_ratio) / m.young_modulus;
    };
    return of(a) + of(b);
  }
  template <class Material>
  static ContactConstants mix(const Material& a, double ri, const Material& b, double rj, double /*section*/) {
    const double root = __builtin_sqrt(ri * rj / (ri + rj));
    return {4 * root / (3 * compression(a, b)), 8 * root / shear(a, b)};
  }
};

}  // namespace rvelab
