// Coulomb friction: the tangential force, with its dashpot, stays within mu times the force that presses the surfaces
// together, |f_t - c_t v_t| <= mu |N| (Cundall and Strack 1979). What is beyond is slip: the spring keeps what the
// dashpot leaves of the limit.
#pragma once

#include "rvelab/lanes/vectors.hpp"

namespace rvelab {

template <class V>
static inline __attribute__((always_inline)) V friction_limit(V friction, V pressing) {
  return friction * magnitude_of(pressing);
}

/// In the plane: the spring's force along the tangent, within the limit.
template <class V>
static inline __attribute__((always_inline)) V within_friction(V trial, V limit) {
  return clamped(trial, limit);
}
/// The same beside a dashpot that takes `viscous` off the spring's force.
template <class V>
static inline __attribute__((always_inline)) V within_friction(V trial, V limit, V viscous) {
  const V total = trial - viscous;
  const V capped = clamped(total, limit);
  return ((total > limit) | (total < -limit)) ? capped + viscous : trial;
}

/// In space: the force vector keeps its direction. `factor` times `rate` is what the dashpot takes; Dashpot is known
/// when a kernel is compiled.
template <bool Dashpot, class V>
static inline __attribute__((always_inline)) Triple<V> within_friction(const Triple<V>& trial, V limit, V factor,
                                                                       const Triple<V>& rate) {
  Triple<V> total = trial;
  if constexpr (Dashpot) total = plus(total, -factor, rate);
  const V squared = dot(total, total), one = V{} + 1.0;
  const auto sliding = squared > limit * limit;
  const V shrink = limit / square_root(sliding ? squared : one);
  Triple<V> capped = times(shrink, total);
  if constexpr (Dashpot) capped = plus(capped, factor, rate);
  return chosen(sliding, capped, trial);
}

}  // namespace rvelab
