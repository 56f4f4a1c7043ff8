// The geometry of pairs of discs for the contact update in the plane (plane.hpp).
#pragma once

#include "rvelab/solver/kernels/integrate_discs.hpp"
#include "rvelab/solver/kernels/plane.hpp"

namespace rvelab {
namespace {

/// What the passes hand on.
struct DiscScratch {
  VecColumn<2> normal;
  ScratchColumn overlap;
  ScratchColumn slip_rate;  ///< along t where the surfaces of undeformed discs meet
  ScratchColumn spin_sum, spin_difference, opening;
};

/// Branch, normal and motion of pairs, from grain rows in one pass: shuffles fill the time of root and division (time
/// of the pair loop, AVX2: 1 with rows in a pass of their own, 0.79 so, 1.07 with the forces in the same pass as the
/// root).
template <class T>
inline __attribute__((always_inline)) void locate_discs(const StepConstants& c, const PairArrays& p, const double* rows,
                                                        long first, long count, DiscScratch& s) {
  constexpr int W = T::W;
  using V = typename Lanes<W>::V;
  for (long k = 0; k < count; k += W) {
    const long at = first + k;
    V following[2];
    const Vec<V, 2> d = gather_differences<W, 2>(rows, p.row_i + at, p.row_j + at, following);
    const Vec<V, 2> b = branch_of(c, p, at, d);
    const V length = square_root(dot(b, b));
    const V inverse = 1.0 / length;
    const Vec<V, 2> n = times(inverse, b);
    const V radius_i = load_as<V>(p.radius_i + at), radius_j = load_as<V>(p.radius_j + at);
    const V radii = radius_i + radius_j;
    s.normal.store(k, n);
    store_as(s.overlap.at + k, radii - length);
    if constexpr (T::Moves) {
      // row_i, row_j kept in registers from above would spill vectors (eight lanes: 204 instructions, loaded again
      // 147); vectors as a whole would be spilled by the barrier.
      const V bx = b.x, by = b.y, nx = n.x, ny = n.y;
      read_memory_again();
      const V spin_i = gather_spins<W>(rows, p.row_i + at), spin_j = gather_spins<W>(rows, p.row_j + at);
      const Vec<V, 2> v = relative_velocity(c, Vec<V, 2>{bx, by}, first_of<2>(following));
      V along = nx * v.y - ny * v.x;
      if constexpr (T::Foreign)
        if (c.slip == Slip::full_radius_ratcheting) along = along * (radii * inverse);
      store_as(s.slip_rate.at + k, along - ((radius_j * spin_j + radius_i * spin_i) + c.spin[2] * radii));
      if constexpr (!T::Foreign) store_as(s.spin_sum.at + k, spin_j + spin_i);
      if constexpr (T::Rolling) store_as(s.spin_difference.at + k, spin_j - spin_i);
      if constexpr (T::Dashpot) store_as(s.opening.at + k, nx * v.x + ny * v.y);
    }
  }
}

/// What the contact update in the plane (plane.hpp) asks of a shape.
struct Discs {
  using By = Disc;
  using Scratch = DiscScratch;
  using Rows = DiscRows;

  template <class T>
  static inline __attribute__((always_inline)) void locate(const StepConstants& c, const PairArrays& p,
                                                           const double* rows, long first, long count, Scratch& s) {
    locate_discs<T>(c, p, rows, first, count, s);
  }
  template <class T>
  static inline __attribute__((always_inline)) auto contact(const StepConstants& c, const PairArrays& p, long at,
                                                            long k, const Scratch& s) {
    using V = typename Lanes<T::W>::V;
    PlaneContact<V> contact;
    const V radius_i = load_as<V>(p.radius_i + at), radius_j = load_as<V>(p.radius_j + at);
    contact.n = s.normal.load<V>(k);
    contact.overlap = load_as<V>(s.overlap.at + k);
    const V half_overlap = 0.5 * contact.overlap;
    contact.lever_i = half_overlap - radius_i;
    contact.lever_j = half_overlap - radius_j;
    if constexpr (T::Moves) {
      contact.slip_rate = load_as<V>(s.slip_rate.at + k);
      if constexpr (!T::Foreign)
        contact.slip_rate = contact.slip_rate + half_overlap * (load_as<V>(s.spin_sum.at + k) + 2.0 * c.spin[2]);
      if constexpr (T::Rolling) contact.spin_difference = load_as<V>(s.spin_difference.at + k);
      if constexpr (T::Dashpot) contact.opening = load_as<V>(s.opening.at + k);
    }
    return contact;
  }
  template <int W>
  static inline __attribute__((always_inline)) bool may_touch(const StepConstants& c, const PairArrays& p,
                                                              const double* rows, long first);
};

/// Whether one of eight pairs touches.
template <int W>
inline __attribute__((always_inline)) bool Discs::may_touch(const StepConstants& c, const PairArrays& p,
                                                            const double* rows, long first) {
  using V = typename Lanes<W>::V;
  auto touching = V{} > 0.0;
#pragma GCC unroll 8
  for (long at = first; at < first + 8; at += W) {
    const Vec<V, 2> b = branch_of(c, p, at, gather_position_differences<W>(rows, p.row_i + at, p.row_j + at));
    const V radii = load_as<V>(p.radius_i + at) + load_as<V>(p.radius_j + at);
    touching = touching | (dot(b, b) < radii * radii);
  }
  return any_of(touching);
}

}  // namespace
}  // namespace rvelab
