// The geometry of pairs of discs for the contact update in the plane (plane.hpp).
#pragma once

#include "rvelab/solver/kernels/plane.hpp"

namespace rvelab {
namespace {

/// What the passes hand on.
struct DiscScratch {
  ScratchColumn dx, dy, du, dv;  ///< place and velocity of j less those of i
  ScratchColumn spin_i, spin_j;
  ScratchColumn nx, ny, length;
  ScratchColumn along, opening;  ///< relative velocity of the centres over the step, along t and along n
};

/// Grain rows to columns. Shuffles cost the same at every width, so this pass keeps to four lanes.
template <class T>
inline __attribute__((always_inline)) void disc_rows(const PairArrays& p, const double* rows, long first, long count,
                                                     DiscScratch& out) {
  constexpr int W = T::W < 4 ? T::W : 4;
  for (long k = 0; k < count; k += W) {
    // Copies: no store of a column can change them, so each is read once.
    std::int32_t i[W], j[W];
    for (int lane = 0; lane < W; ++lane) i[lane] = p.row_i[first + k + lane], j[lane] = p.row_j[first + k + lane];
    motion_to_columns<T, W>(rows, i, j, k, out);
  }
}

/// Branch, normal and the motion of the centres.
template <class T>
inline __attribute__((always_inline)) void disc_places(const StepConstants& c, const PairArrays& p, long first,
                                                       long count, DiscScratch& s) {
  using V = typename Lanes<T::W>::V;
  const double half_dt = 0.5 * c.dt;
  for (long k = 0; k < count; k += T::W) {
    const long at = first + k;
    const V image_x = load_as<V>(p.image[0] + at), image_y = load_as<V>(p.image[1] + at);
    const V bx = load_as<V>(s.dx.at + k) + (c.lattice.xx * image_x + c.lattice.xy * image_y);
    const V by = load_as<V>(s.dy.at + k) + c.lattice.yy * image_y;
    const V length = square_root(bx * bx + by * by);
    const V inverse = 1.0 / length;
    const V nx = bx * inverse, ny = by * inverse;
    store_as(s.nx.at + k, nx);
    store_as(s.ny.at + k, ny);
    store_as(s.length.at + k, length);
    if constexpr (T::Advance || T::Dashpot) {
      const V du = load_as<V>(s.du.at + k), dv = load_as<V>(s.dv.at + k);
      const V px = bx - half_dt * du, py = by - half_dt * dv;
      const V vx = du + (c.rate.xx * px + c.rate.xy * py), vy = dv + c.rate.yy * py;
      V along = nx * vy - ny * vx;
      if constexpr (T::slip == Slip::full_radius_ratcheting)
        along = along * ((load_as<V>(p.radius_i + at) + load_as<V>(p.radius_j + at)) * inverse);
      store_as(s.along.at + k, along);
      if constexpr (T::Dashpot) store_as(s.opening.at + k, nx * vx + ny * vy);
    }
  }
}

/// What the contact update in the plane (plane.hpp) asks of a shape.
struct Discs {
  using Scratch = DiscScratch;
  static constexpr bool round = true;

  template <class T>
  static inline __attribute__((always_inline)) void locate(const StepConstants& c, const PairArrays& p,
                                                           const double* rows, long first, long count, Scratch& s) {
    disc_rows<T>(p, rows, first, count, s);
    disc_places<T>(c, p, first, count, s);
  }
  template <class T>
  static inline __attribute__((always_inline)) auto contact(const StepConstants& c, const PairArrays& p, long at,
                                                            long k, const Scratch& s) {
    using V = typename Lanes<T::W>::V;
    PlaneContact<V> contact;
    const V radius_i = load_as<V>(p.radius_i + at), radius_j = load_as<V>(p.radius_j + at);
    const V radii = radius_i + radius_j;
    contact.nx = load_as<V>(s.nx.at + k);
    contact.ny = load_as<V>(s.ny.at + k);
    contact.overlap = radii - load_as<V>(s.length.at + k);
    const V half_overlap = 0.5 * contact.overlap;
    contact.lever_i = half_overlap - radius_i;
    contact.lever_j = half_overlap - radius_j;
    if constexpr (T::Advance || T::Dashpot) {
      const V spin_i = load_as<V>(s.spin_i.at + k), spin_j = load_as<V>(s.spin_j.at + k);
      contact.slip_rate = load_as<V>(s.along.at + k) - ((radius_j * spin_j + radius_i * spin_i) + c.spin[2] * radii);
      if constexpr (T::slip == Slip::consistent)
        contact.slip_rate = contact.slip_rate + half_overlap * ((spin_j + spin_i) + 2.0 * c.spin[2]);
      if constexpr (T::Rolling) contact.spin_difference = spin_j - spin_i;
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
    const V image_x = load_as<V>(p.image[0] + at), image_y = load_as<V>(p.image[1] + at);
    const V bx = d[0] + (c.lattice.xx * image_x + c.lattice.xy * image_y);
    const V by = d[1] + c.lattice.yy * image_y;
    const V radii = load_as<V>(p.radius_i + at) + load_as<V>(p.radius_j + at);
    touching = touching | (bx * bx + by * by < radii * radii);
  }
  return any_of(touching);
}

}  // namespace
}  // namespace rvelab
