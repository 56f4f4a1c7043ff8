// Linear contact law (Liang and Zhao 2019, eq. 20-23, 26-27; with given stiffnesses Liang et al. 2023, table 2).
//
//   f_n = kn delta,   f_t <- f_t - kt du_t
//
// kn, kt in N/m come from mix() (model.hpp); delta in m. The next law is written like this one: how f_n and the current
// tangential stiffness follow from the overlap, and how the stored tangential force is carried as the overlap changes.
// V is a double or a vector of doubles (solver/lanes.hpp); functions have internal linkage because every instruction
// set compiles its own copy.
#pragma once

namespace rvelab {

struct LinearLaw {
  static constexpr bool needs_root_overlap = false;
  static constexpr bool stores_root_overlap = false;

  template <class V>
  static inline __attribute__((always_inline)) V normal_force(V kn, V overlap, V /*root*/) {
    return kn * overlap;
  }
  template <class V>
  static inline __attribute__((always_inline)) V tangential_stiffness(V kt, V /*root*/) {
    return kt;
  }
  /// Factor on the stored force and moment before the increment.
  template <class V>
  static inline __attribute__((always_inline)) V carried(V /*root*/, V /*last_root*/, bool /*unload_rescale*/) {
    return V{} + 1.0;
  }
};

}  // namespace rvelab
