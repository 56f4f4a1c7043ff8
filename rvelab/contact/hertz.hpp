// Hertz contacts.
//
// Given constants (Qu, Feng and Wang, eq. 16-17):  f_n = k delta^1.5 (k in N/m^1.5),  f_t <- f_t - kt du_t, kt in N/m.
// Hertz-Mindlin (Li et al. 2023, eq. 18-21):       f_n = 4/3 E* sqrt(r* delta) delta, kt = 8 G* sqrt(r* delta),
//   f_t <- f_t s - kt du_t, with s = sqrt(delta/delta_old) where the overlap falls (`unload_rescale`; without it energy
//   is made on unloading), else 1. The constants before sqrt(delta) come from mix() (model.hpp).
// delta^1.5 = delta sqrt(delta): no libm in what touches state.
#pragma once

namespace rvelab {

struct HertzGivenLaw {
  static constexpr bool needs_root_overlap = true;
  static constexpr bool stores_root_overlap = false;

  template <class V>
  static inline __attribute__((always_inline)) V normal_force(V kn, V overlap, V root) {
    return kn * (overlap * root);
  }
  template <class V>
  static inline __attribute__((always_inline)) V tangential_stiffness(V kt, V /*root*/) {
    return kt;
  }
  template <class V>
  static inline __attribute__((always_inline)) V carried(V /*root*/, V /*last_root*/, bool /*unload_rescale*/) {
    return V{} + 1.0;
  }
};

struct HertzMindlinLaw {
  static constexpr bool needs_root_overlap = true;
  static constexpr bool stores_root_overlap = true;

  template <class V>
  static inline __attribute__((always_inline)) V normal_force(V kn, V overlap, V root) {
    return kn * (overlap * root);
  }
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
};

}  // namespace rvelab
