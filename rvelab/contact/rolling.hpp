// Rolling resistance (Liang and Zhao 2019, eq. 24-28): a moment between the grains, incremental and capped,
//   M <- M - k_r (I - n n)(w_j - w_i) dt on grain j (and -M on i),   |M| <= min(eta_i ri, eta_j rj) f_n.
// k_r = kt ri rj beta comes from mix(); twisting is free. In 2D M and w lie along z and nothing turns.
#pragma once

namespace rvelab {

/// 2D: the capped moment. `trial` is carried history minus k_r (w_j - w_i) dt.
template <class V>
static inline __attribute__((always_inline)) V capped_moment(V trial, V cap) {
  const V upper = (trial > cap) ? cap : trial;
  return (upper < -cap) ? -cap : upper;
}

}  // namespace rvelab
