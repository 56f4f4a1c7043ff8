// Normal forces of superellipsoids: from rows of positions, quaternions and shapes to forces and moments, W pairs at a
// time.
//
//   F on j = f n,   F on i = -f n,   M_i = x x (-f n),   M_j = (x - d) x f n,   x the contact from the centre of i
//
// so that forces and moments of a pair are in balance; with f a function of the overlap alone they have an energy
// (superellipsoid/overlap.hpp). Slip, rolling and dashpots are those of space.hpp, at the same point.
#pragma once

#include "rvelab/superellipsoid/lanes.hpp"

namespace rvelab {
namespace {

/// Columns of a grain's row, from 0 on: x y z and the rolling radius, m; quaternion w x y z into the world's axes; half
/// axes, m, and share_xy; share_z, root_xy, root_z (superellipsoid/support.hpp), one to spare.
constexpr int superellipsoid_row = 16;

template <int W>
struct SuperellipsoidColumns {
  using V = typename Lanes<W>::V;
  V columns[superellipsoid_row];
  Triple<V> position() const { return {columns[0], columns[1], columns[2]}; }
  SuperellipsoidForm<V> form() const {
    return {{columns[8], columns[9], columns[10]}, columns[11], columns[12], columns[13], columns[14], columns[3]};
  }
  SuperellipsoidAxes<V> axes() const {
    const V w = columns[4], x = columns[5], y = columns[6], z = columns[7];
    const V xx = x * x, yy = y * y, zz = z * z, xy = x * y, xz = x * z, yz = y * z, wx = w * x, wy = w * y, wz = w * z;
    return {{1.0 - 2.0 * (yy + zz), 2.0 * (xy + wz), 2.0 * (xz - wy)},
            {2.0 * (xy - wz), 1.0 - 2.0 * (xx + zz), 2.0 * (yz + wx)},
            {2.0 * (xz + wy), 2.0 * (yz - wx), 1.0 - 2.0 * (xx + yy)}};
  }
};

/// Rows of W grains.
template <int W>
inline __attribute__((always_inline)) SuperellipsoidColumns<W> superellipsoid_columns(const double* rows,
                                                                                      const std::int32_t* grains) {
  SuperellipsoidColumns<W> all;
  for (int part = 0; part < superellipsoid_row; part += 4)
    ColumnsOf<W>::load([&](int k) { return rows + long(grains[k]) * superellipsoid_row + part; }, all.columns + part);
  return all;
}

/// On the second grain of each pair; the first has the opposite force.
template <class V>
struct NormalForces {
  V overlap;
  Triple<V> force, moment_i, moment_j;  ///< N, N m
};

/// `shift`: from the cell, added to positions of j less those of i, m. `guess`: directions to begin with, which forces
/// do not depend on. `law`: f of the overlap, N, for overlaps that are not negative.
template <int W, class V, class Law>
inline __attribute__((always_inline)) NormalForces<V> normal_forces(const double* rows, const std::int32_t* grains_i,
                                                                    const std::int32_t* grains_j,
                                                                    const Triple<V>& shift, Triple<V>& guess,
                                                                    const Law& law) {
  const SuperellipsoidColumns<W> i = superellipsoid_columns<W>(rows, grains_i),
                                 j = superellipsoid_columns<W>(rows, grains_j);
  const V one = V{} + 1.0, zero = V{};
  const SuperellipsoidPair<V> pair = {i.form(), j.form(), i.axes(), j.axes(),
                                      plus(plus(j.position(), -one, i.position()), one, shift)};
  const ContactsOf<V> at = contacts_of(pair, guess);
  const auto touch = at.overlap > 0.0;
  const V size = touch ? law(touch ? at.overlap : zero) : zero;
  const Triple<V> force = chosen(touch, times(size, at.n), Triple<V>{zero, zero, zero});
  const Triple<V> arm_i = chosen(touch, at.point, Triple<V>{zero, zero, zero});
  const Triple<V> arm_j = chosen(touch, plus(at.point, -one, pair.branch), Triple<V>{zero, zero, zero});
  return {touch ? at.overlap : zero, force, cross(force, arm_i), cross(arm_j, force)};
}

}  // namespace
}  // namespace rvelab
