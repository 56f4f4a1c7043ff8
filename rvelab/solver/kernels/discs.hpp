// The geometry of pairs of discs for the contact update in the plane (plane.hpp).
#pragma once

#include "rvelab/solver/kernels/integrate_discs.hpp"
#include "rvelab/solver/kernels/plane.hpp"

namespace rvelab {
namespace {

/// What the passes hand on.
struct DiscScratch {
  ScratchColumn nx, ny, overlap;
  ScratchColumn slip_rate;  ///< along t where the surfaces of undeformed discs meet
  ScratchColumn spin_sum, spin_difference, opening;
};

/// Branch, normal and motion of pairs, from grain rows in one pass: shuffles fill the time of root and division (time
/// of the pair loop, AVX2: 1 with rows in a pass of their own, 0.79 so, 1.07 with the forces in the same pass as the
/// root).
template <class T>
inline __attribute__((always_inline)) void disc_places(const StepConstants& c, const PairArrays& p, const double* rows,
                                                       long first, long count, DiscScratch& s) {
  constexpr int W = T::W;
  using V = typename Lanes<W>::V;
  const double half_dt = 0.5 * c.dt;
  for (long k = 0; k < count; k += W) {
    const long at = first + k;
    V d[4];
    gather_differences<W>(rows, p.row_i + at, p.row_j + at, d);
    V bx = d[0], by = d[1];
    add_image_in_plane(c, p, at, bx, by);
    const V length = square_root(bx * bx + by * by);
    const V inverse = 1.0 / length;
    const V nx = bx * inverse, ny = by * inverse;
    const V radius_i = load_as<V>(p.radius_i + at), radius_j = load_as<V>(p.radius_j + at);
    const V radii = radius_i + radius_j;
    store_as(s.nx.at + k, nx);
    store_as(s.ny.at + k, ny);
    store_as(s.overlap.at + k, radii - length);
    if constexpr (T::Advance || T::Dashpot) {
      // row_i, row_j kept in registers from above would spill vectors (eight lanes: 204 instructions, loaded again
      // 147).
      read_memory_again();
      const V spin_i = gather_spins<W>(rows, p.row_i + at), spin_j = gather_spins<W>(rows, p.row_j + at);
      const V du = d[2], dv = d[3];
      const V px = bx - half_dt * du, py = by - half_dt * dv;
      const V vx = du + (c.rate.xx * px + c.rate.xy * py), vy = dv + c.rate.yy * py;
      V along = nx * vy - ny * vx;
      if constexpr (T::slip == Slip::full_radius_ratcheting) along = along * (radii * inverse);
      store_as(s.slip_rate.at + k, along - ((radius_j * spin_j + radius_i * spin_i) + c.spin[2] * radii));
      if constexpr (T::slip == Slip::consistent) store_as(s.spin_sum.at + k, spin_j + spin_i);
      if constexpr (T::Rolling) store_as(s.spin_difference.at + k, spin_j - spin_i);
      if constexpr (T::Dashpot) store_as(s.opening.at + k, nx * vx + ny * vy);
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
    disc_places<T>(c, p, rows, first, count, s);
  }
  template <class T>
  static inline __attribute__((always_inline)) auto contact(const StepConstants& c, const PairArrays& p, long at,
                                                            long k, const Scratch& s) {
    using V = typename Lanes<T::W>::V;
    PlaneContact<V> contact;
    const V radius_i = load_as<V>(p.radius_i + at), radius_j = load_as<V>(p.radius_j + at);
    contact.nx = load_as<V>(s.nx.at + k);
    contact.ny = load_as<V>(s.ny.at + k);
    contact.overlap = load_as<V>(s.overlap.at + k);
    const V half_overlap = 0.5 * contact.overlap;
    contact.lever_i = half_overlap - radius_i;
    contact.lever_j = half_overlap - radius_j;
    if constexpr (T::Advance || T::Dashpot) {
      contact.slip_rate = load_as<V>(s.slip_rate.at + k);
      if constexpr (T::slip == Slip::consistent)
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
    V d[2];
    gather_place_differences<W>(rows, p.row_i + at, p.row_j + at, d);
    V bx = d[0], by = d[1];
    add_image_in_plane(c, p, at, bx, by);
    const V radii = load_as<V>(p.radius_i + at) + load_as<V>(p.radius_j + at);
    touching = touching | (bx * bx + by * by < radii * radii);
  }
  return any_of(touching);
}

}  // namespace
}  // namespace rvelab
