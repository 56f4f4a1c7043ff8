// The geometry of pairs of superellipsoids for the contact update in space (space.hpp), where they lie by
// superellipsoid_places.hpp.
//
//   slip and opening: those of v + w_j x x_j - w_i x x_i,   T_i = -x_i x F,   T_j = x_j x F,   F the force on j
//
// x_i - x_j is the branch, whatever they are, so that moments balance to rounding. The overlap changes by -n.(that
// velocity): h_i(n) changes by n.(w x x) where the body turns, and a turn of n changes nothing. So the springs do no
// work but their own.
#pragma once

#include "rvelab/solver/kernels/superellipsoid_places.hpp"

namespace rvelab {
namespace {

/// What PlaceKernel asks for: n, overlap, contact point from the centre of i, R* with Curvature.
template <int W, bool Ellipsoids, bool Curvature>
void superellipsoid_pair_places(const StepConstants& c, const PairArrays& p, const double* rows, long begin, long end,
                                double* places) {
  using V = typename Lanes<W>::V;
  SuperellipsoidScratch s;
  double guesses[8 * chunk_pairs];  // not kept: threads may look at one pair together
  for (long first = begin; first < end; first += chunk_pairs) {
    const long count = end - first < chunk_pairs ? end - first : chunk_pairs;
    for (long k = 0; k < 8 * count; ++k) guesses[k] = p.directions[8 * first + k];
    locate_superellipsoids<W, Ellipsoids, Curvature>(c, p, rows, first, count, guesses, s);
    for (long k = 0; k < count; k += W) {
      const Triple<V> n = s.normal.load<V>(k), point = s.arm_i.load<V>(k);
      V radius = {};
      if constexpr (Curvature) radius = load_as<V>(s.radius.at + k);
      const V near[4] = {n.x, n.y, n.z, load_as<V>(s.overlap.at + k)}, far[4] = {point.x, point.y, point.z, radius};
      rows_of<W>(near, places + place_row_length * (first + k), place_row_length);
      rows_of<W>(far, places + place_row_length * (first + k) + 4, place_row_length);
    }
  }
}

/// Whether one of eight pairs is not shown to be apart: of ellipsoids by the direction in which the branch leaves that
/// of the summed matrices.
template <int W>
__attribute__((noinline)) bool ellipsoids_may_touch(const StepConstants& c, const PairArrays& p, const double* rows,
                                                    long first) {
  using V = typename Lanes<W>::V;
  for (long at = first; at < first + 8; at += W) {
    const EllipsoidPair<V> pair = ellipsoids_of(superellipsoid_pair<W>(c, p, rows, at));
    const Triple<V> n = first_direction(pair);
    const V heights = square_root(dot(n, times(pair.i, n))) + square_root(dot(n, times(pair.j, n)));
    if (any_of(!(heights - dot(n, pair.branch) < -1e-12 * heights))) return true;
  }
  return false;
}
/// Of others by the direction kept, or the branch where there is none.
template <int W>
__attribute__((noinline)) bool superellipsoids_may_touch(const StepConstants& c, const PairArrays& p,
                                                         const double* rows, long first) {
  using V = typename Lanes<W>::V;
  for (long at = first; at < first + 8; at += W) {
    const SuperellipsoidPair<V> pair = superellipsoid_pair<W>(c, p, rows, at);
    const Triple<V> kept = triple_of<W>(p.directions + 8 * at, 8);
    const auto has = dot(kept, kept) >= 0.25;
    const OverlapAt<V> along = overlap_at(pair, chosen(has, kept, of_length_1(pair.branch)));
    if (any_of(!(along.overlap < -1e-12 * (along.i.height + along.j.height)))) return true;
  }
  return false;
}

/// What the contact update in space (space.hpp) asks of a shape. StepConstants says whether all are ellipsoids: one
/// branch a chunk, in loops that are the same for both.
struct SuperellipsoidPairs {
  using By = SuperellipsoidGrain;
  using Scratch = SuperellipsoidScratch;

  template <class T>
  static inline __attribute__((always_inline)) void locate(const StepConstants& c, const PairArrays& p,
                                                           const double* rows, long first, long count, Scratch& s) {
    double* directions = p.directions + 8 * first;
    if (c.ellipsoids)
      locate_superellipsoids<T::W, true, T::Curvature>(c, p, rows, first, count, directions, s);
    else
      locate_superellipsoids<T::W, false, T::Curvature>(c, p, rows, first, count, directions, s);
  }
  /// R*/r*.
  template <class V>
  static inline __attribute__((always_inline)) V radius_ratio(const PairArrays& p, long at, long k, const Scratch& s) {
    return radius_ratio_of(load_as<V>(s.radius.at + k), load_as<V>(p.radius_i + at), load_as<V>(p.radius_j + at));
  }
  template <class V>
  static inline __attribute__((always_inline)) V overlap(long k, const Scratch& s) {
    return load_as<V>(s.overlap.at + k);
  }
  template <class T, class V>
  static inline __attribute__((always_inline)) SpaceMotion<V> motion(const StepConstants& c, const PairArrays& p,
                                                                     const double* rows, long at, const Triple<V>& n,
                                                                     long k, Scratch& s) {
    constexpr int W = T::W;
    const std::int32_t *i = p.row_i + at, *j = p.row_j + at;
    V a[4], b[4];
    ColumnsOf<W>::load([=](int lane) { return rows + i[lane] + 8; }, a);
    ColumnsOf<W>::load([=](int lane) { return rows + j[lane] + 8; }, b);
    if constexpr (T::Rolling && T::Advance) s.spin_difference.store(k, first_of<3>(b) - first_of<3>(a));
    const Triple<V> centres = relative_velocity(c, s.branch.load<V>(k), gather_differences<W, 3>(rows + 4, i, j));
    // The mean spin of the cell is added to both grains.
    const Triple<V> wi = with_cell_spin(c, first_of<3>(a), 1.0), wj = with_cell_spin(c, first_of<3>(b), 1.0);
    const Triple<V> by_j = cross(wj, s.arm_j.load<V>(k)), by_i = cross(wi, s.arm_i.load<V>(k));
    const Triple<V> at_point = (centres + by_j) - by_i;
    const V opening = dot(n, at_point);
    return {plus(at_point, -opening, n), opening, 0.5 * dot(n, wi + wj)};
  }
  /// Force on j and torque on j; the torque on i stands in PairArrays::solid.
  template <class T>
  static inline __attribute__((always_inline)) void force_rows(const PairArrays& p, long first, long count,
                                                               const Scratch& s) {
    constexpr int W = T::W;
    using V = typename Lanes<W>::V;
    for (long k = 0; k < count; k += W) {
      const long at = first + k;
      const V normal = load_as<V>(s.normal_force.at + k);
      const Triple<V> along = T::Dashpot ? s.velocity.load<V>(k) : load_vec<V>(p.tangential, at);
      const Triple<V> f = plus(along, normal, s.normal.load<V>(k));
      const Triple<V> on_j = cross(s.arm_j.load<V>(k), f), on_i = cross(f, s.arm_i.load<V>(k));
      constexpr int length = force_row_length(3);
      rows_of<W>(f, V{}, p.force + length * at, length);
      rows_of<W>(on_j, V{}, p.force + length * at + 4, length);
      rows_of<W>(on_i, V{}, p.solid + length * at + 4, length);
    }
  }
  template <int W>
  static inline __attribute__((always_inline)) bool may_touch(const StepConstants& c, const PairArrays& p,
                                                              const double* rows, long first) {
    return c.ellipsoids ? ellipsoids_may_touch<W>(c, p, rows, first) : superellipsoids_may_touch<W>(c, p, rows, first);
  }
};

}  // namespace
}  // namespace rvelab
