// The geometry of pairs of spheres for the contact update in space (space.hpp).
#pragma once

#include "rvelab/solver/kernels/space.hpp"

namespace rvelab {
namespace {

struct SphereScratch : SpaceScratch {
  ScratchColumn length, radii;
};

/// Branch, normal and the motion of the centres, from grain rows in one pass as those of discs (spheres: 0.97 of
/// the time with four lanes, 0.99 with eight).
template <class T>
inline __attribute__((always_inline)) void locate_spheres(const StepConstants& c, const PairArrays& p,
                                                          const double* rows, long first, long count,
                                                          SphereScratch& s) {
  constexpr int W = T::W;
  using V = typename Lanes<W>::V;
  for (long k = 0; k < count; k += W) {
    const long at = first + k;
    const std::int32_t *i = p.row_i + at, *j = p.row_j + at;
    V d[4];
    gather_columns<W>(rows, i, j, 0, quad<W>(-1.0, -1.0, -1.0, 1.0), d);
    const Triple<V> b = branch_of(c, p, at, first_of<3>(d));
    const V length = square_root(dot(b, b));
    s.normal.store(k, times(1.0 / length, b));
    store_as(s.length.at + k, length);
    store_as(s.radii.at + k, d[3]);
    if constexpr (T::Moves) {
      if constexpr (W == 8) read_memory_again();  // as in discs.hpp
      s.velocity.store(k, relative_velocity(c, b, gather_differences<W, 3>(rows + 4, i, j)));
    }
  }
}

/// What the contact update in space (space.hpp) asks of a shape.
struct Spheres {
  using By = Sphere;
  using Scratch = SphereScratch;

  template <class T>
  static inline __attribute__((always_inline)) void locate(const StepConstants& c, const PairArrays& p,
                                                           const double* rows, long first, long count, Scratch& s) {
    locate_spheres<T>(c, p, rows, first, count, s);
  }
  template <class V>
  static inline __attribute__((always_inline)) V overlap(long k, const Scratch& s) {
    return load_as<V>(s.radii.at + k) - load_as<V>(s.length.at + k);
  }
  /// Spins are loaded where they are used (time of the pair loop: eight lanes 0.94 of that with a pass for them, four
  /// lanes 1.02).
  template <class T, class V>
  static inline __attribute__((always_inline)) SpaceMotion<V> motion(const StepConstants& c, const PairArrays& p,
                                                                     const double* rows, long at, const Triple<V>& n,
                                                                     long k, Scratch& s) {
    const std::int32_t *i = p.row_i + at, *j = p.row_j + at;
    V a[4], b[4];
    ColumnsOf<T::W>::load([=](int lane) { return rows + i[lane] + 8; }, a);
    ColumnsOf<T::W>::load([=](int lane) { return rows + j[lane] + 8; }, b);
    if constexpr (T::Rolling && T::Advance) s.spin_difference.store(k, first_of<3>(b) - first_of<3>(a));
    const V radii = load_as<V>(s.radii.at + k), length = load_as<V>(s.length.at + k), one = V{} + 1.0;
    // The mean spin of the cell is added to both grains.
    const Triple<V> u = s.velocity.load<V>(k);
    const Triple<V> spins = with_cell_spin(c, first_of<3>(a) + first_of<3>(b), 2.0);
    Triple<V> arms = {(b[3] * b[0] + a[3] * a[0]) + c.spin[0] * radii, (b[3] * b[1] + a[3] * a[1]) + c.spin[1] * radii,
                      (b[3] * b[2] + a[3] * a[2]) + c.spin[2] * radii};
    const V opening = dot(n, u);
    Triple<V> along = plus(u, -opening, n);
    if constexpr (!T::Foreign) arms = plus(arms, -(0.5 * (radii - length)), spins);
    if constexpr (T::Foreign)
      if (c.slip == Slip::full_radius_ratcheting) along = times(radii / length, along);
    return {plus(along, -one, cross(arms, n)), opening, 0.5 * dot(n, spins)};
  }
  template <int W>
  static inline __attribute__((always_inline)) bool may_touch(const StepConstants& c, const PairArrays& p,
                                                              const double* rows, long first);
};

/// Whether one of eight pairs touches.
template <int W>
inline __attribute__((always_inline)) bool Spheres::may_touch(const StepConstants& c, const PairArrays& p,
                                                              const double* rows, long first) {
  using V = typename Lanes<W>::V;
  auto touching = V{} > 0.0;
#pragma GCC unroll 8
  for (long at = first; at < first + 8; at += W) {
    V d[4];
    gather_columns<W>(rows, p.row_i + at, p.row_j + at, 0, quad<W>(-1.0, -1.0, -1.0, 1.0), d);
    const Triple<V> b = branch_of(c, p, at, first_of<3>(d));
    touching = touching | (dot(b, b) < d[3] * d[3]);
  }
  return any_of(touching);
}

}  // namespace
}  // namespace rvelab
