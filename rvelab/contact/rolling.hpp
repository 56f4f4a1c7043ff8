// Rolling resistance (Liang and Zhao 2019, eq. 24-28): a moment between the grains, incremental and capped,
//   M <- M - k_r (I - n n)(w_j - w_i) dt on grain j (and -M on i),   |M| <= min(eta_i ri, eta_j rj) N,
// N the force that presses the surfaces together, f_n of most laws.
// k_r = kt ri rj beta comes from mix(); twisting is free. In 2D M and w lie along z and nothing turns.
#pragma once

#include "rvelab/lanes/vectors.hpp"

namespace rvelab {

/// In the plane. `trial` is carried history minus k_r (w_j - w_i) dt.
template <class V>
static inline __attribute__((always_inline)) V capped_moment(V trial, V cap) {
  const V upper = (trial > cap) ? cap : trial;
  return (upper < -cap) ? -cap : upper;
}

/// In space: the moment keeps its direction.
template <class V>
static inline __attribute__((always_inline)) Triple<V> capped_moment(const Triple<V>& trial, V cap) {
  const V squared = dot(trial, trial), one = V{} + 1.0;
  const auto rolling_over = squared > cap * cap;
  const V shrink = cap / square_root(rolling_over ? squared : one);
  return times(rolling_over ? shrink : one, trial);
}

}  // namespace rvelab
