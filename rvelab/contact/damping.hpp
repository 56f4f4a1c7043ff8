// Contact dashpot and Cundall's local damping.
//
// Dashpot: f_n -= c_n v_n, f_t -= (ratio c_n) v_t, with v_n > 0 as the grains part and c_n = cn delta^p:
//   p = 0    coefficient (any law), restitution with the linear laws (cn = 2 zeta sqrt(m* kn)),
//   p = 1/2  viscoelastic, cn = eta sqrt(r*) m* (LAMMPS' name and form),
//   p = 1/4  restitution with Hertz laws, cn = sqrt(5) zeta sqrt(m* k); tsuji: cn = alpha sqrt(m* k) with the
//            polynomial alpha(e) that LAMMPS fits to Tsuji et al. 1992, for its records.
// Restitution with cones: p = 1/2, cn = sqrt(6) zeta sqrt(m* k); with rough surfaces: hertz_rough.hpp.
// zeta from the coefficient of restitution: impact.hpp. A dashpot acts at a rate only: a sub-step in quasi-static
// loading is no second. Local damping (Liang and Zhao 2019, eq. 29): f <- f - alpha |f| v/|v| on fluctuation
// velocities, or per component f_k <- f_k - alpha |f_k| sign(v_k), which depends on the axes. v is the velocity half a
// step ahead, so that a grain at rest feels (1 - alpha) of its force instead of a jump in sign.
#pragma once

#include "rvelab/lanes/lanes.hpp"

namespace rvelab {

/// root = sqrt(overlap).
template <class V>
static inline __attribute__((always_inline)) V dashpot_coefficient(V cn, V root, int quarters_of_power) {
  if (quarters_of_power == 0) return cn;
  if (quarters_of_power == 2) return cn * root;
  return cn * square_root(root);
}

/// alpha |f| / |v|, zero where v is.
template <class V>
static inline __attribute__((always_inline)) V local_damping_factor(double alpha, V force_squared, V velocity_squared) {
  const V one = V{} + 1.0;
  const V safe = (velocity_squared > 0.0) ? velocity_squared : one;
  const V factor = alpha * square_root(force_squared / safe);
  return (velocity_squared > 0.0) ? factor : V{};
}

/// f - alpha |f| sign(v)
template <class V>
static inline __attribute__((always_inline)) V damped_component(double alpha, V force, V velocity) {
  const V magnitude = (force < 0.0) ? -force : force;
  const V cut = alpha * magnitude;
  return force - ((velocity > 0.0) ? cut : ((velocity < 0.0) ? -cut : V{}));
}

}  // namespace rvelab
