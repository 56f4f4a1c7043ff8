// Branches and motion of pairs and grains, once for plane and space, W at a time or one.
//
// Sums are bracketed as x + (y + z), so that the same formula gives the same bits wherever it stands.
#pragma once

#include "rvelab/lanes/vectors.hpp"
#include "rvelab/solver/kernels/configuration.hpp"

namespace rvelab {
namespace {

/// An upper triangular matrix times a vector.
template <class V, int D>
inline __attribute__((always_inline)) Vec<V, D> mapped(const UpperTriangle& m, const Vec<V, D>& a) {
  if constexpr (D == 2)
    return {m.xx * a.x + m.xy * a.y, m.yy * a.y};
  else
    return {m.xx * a.x + (m.xy * a.y + m.xz * a.z), m.yy * a.y + m.yz * a.z, m.zz * a.z};
}
/// A matrix of three rows of three times a vector.
template <class V, int D>
inline __attribute__((always_inline)) Vec<V, D> mapped(const double* m, const Vec<V, D>& a) {
  if constexpr (D == 2)
    return {m[0] * a.x + m[1] * a.y, m[3] * a.x + m[4] * a.y};
  else
    return {m[0] * a.x + (m[1] * a.y + m[2] * a.z), m[3] * a.x + (m[4] * a.y + m[5] * a.z),
            m[6] * a.x + (m[7] * a.y + m[8] * a.z)};
}

/// Branches, from the positions in the cell of j less those of i, and the images of j.
template <class V, int D>
inline __attribute__((always_inline)) Vec<V, D> branch_with_image(const UpperTriangle& lattice, const Vec<V, D>& d,
                                                                  const Vec<V, D>& image) {
  return d + mapped(lattice, image);
}
/// The same of contacts, of which most blocks of eight have no image. By components: whole vectors that two branches
/// give would go through memory (discs, four lanes: 21 instructions more in 410).
template <class V, int D>
inline __attribute__((always_inline)) Vec<V, D> branch_of(const StepConstants& c, const PairArrays& p, long at,
                                                          const Vec<V, D>& d) {
  V x = d.x, y = d.y, z = {};
  if constexpr (D == 3) z = d.z;
  if (p.shifted[std::size_t(at) / 8]) {
    const Vec<V, D> shift = mapped(c.lattice, load_vec<V, D>(p.image, at));
    x = x + shift.x;
    y = y + shift.y;
    if constexpr (D == 3) z = z + shift.z;
  }
  if constexpr (D == 2)
    return {x, y};
  else
    return {x, y, z};
}

/// Velocity of the centres of j against those of i over the step, from their branch and dv'.
template <class V, int D>
inline __attribute__((always_inline)) Vec<V, D> relative_velocity(const StepConstants& c, const Vec<V, D>& branch,
                                                                  const Vec<V, D>& dv) {
  return dv + mapped(c.rate, minus(branch, 0.5 * c.dt, dv));
}

/// Spins in space, with that of the cell as often as `grains` are in the sum.
template <class V>
inline __attribute__((always_inline)) Triple<V> with_cell_spin(const StepConstants& c, const Triple<V>& spin,
                                                               double grains) {
  return {spin.x + grains * c.spin[0], spin.y + grains * c.spin[1], spin.z + grains * c.spin[2]};
}

template <class V>
inline __attribute__((always_inline)) Triple<V> without_cell_spin(const StepConstants& c, const Triple<V>& spin) {
  return {spin.x - c.spin[0], spin.y - c.spin[1], spin.z - c.spin[2]};
}

/// v' after the step; `gained`: dt f/m.
template <bool AtRate, class V, int D>
inline __attribute__((always_inline)) Vec<V, D> next_velocity(const StepConstants& c, const Vec<V, D>& v,
                                                              const Vec<V, D>& gained) {
  if constexpr (AtRate)
    return mapped(c.momentum_map, v) + mapped(c.force_map, gained);
  else
    return v + gained;
}
/// Positions after the step, with the velocity that it ends with.
template <class V, int D>
inline __attribute__((always_inline)) Vec<V, D> next_position(const StepConstants& c, const Vec<V, D>& x,
                                                              const Vec<V, D>& v) {
  return mapped(c.map, x) + mapped(c.velocity_map, v);
}

}  // namespace
}  // namespace rvelab
