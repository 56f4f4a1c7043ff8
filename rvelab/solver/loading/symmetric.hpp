// Symmetric matrices of two or three rows, one or one in each lane, and their largest eigenvalues.
#pragma once

#include "rvelab/lanes/vectors.hpp"

namespace rvelab {

namespace {

/// Symmetric D x D matrix, or one in each lane.
template <int D, class V = double>
struct Symmetric {
  V xx = {}, xy = {}, yy = {}, xz = {}, yz = {}, zz = {};
};
template <class V>
struct Symmetric<2, V> {
  V xx = {}, xy = {}, yy = {};
};

/// along n n + across I.
template <int D>
inline __attribute__((always_inline)) Symmetric<D> stiffness_along(double along, double across,
                                                                   const Vec<double, D>& n) {
  Symmetric<D> m{along * (n.x * n.x) + across, along * (n.x * n.y), along * (n.y * n.y) + across};
  if constexpr (D == 3) {
    m.xz = along * (n.x * n.z);
    m.yz = along * (n.y * n.z);
    m.zz = along * (n.z * n.z) + across;
  }
  return m;
}

template <int D>
inline __attribute__((always_inline)) void add_to(Symmetric<D>& m, const Symmetric<D>& more) {
  m.xx += more.xx;
  m.xy += more.xy;
  m.yy += more.yy;
  if constexpr (D == 3) {
    m.xz += more.xz;
    m.yz += more.yz;
    m.zz += more.zz;
  }
}

/// Largest eigenvalue of a symmetric positive matrix, from above: exact in the plane, (tr M^8)^(1/8) in space, at most
/// 3^(1/8) = 1.15 too much. Nothing that depends on the axes (row sums) will do: the scaled masses, and with them the
/// path, must not know how the specimen is turned. An eigenvalue solver took a tenth of the stepping time.
template <class V>
V largest_eigenvalue(const Symmetric<2, V>& m) {
  const V half = 0.5 * (m.xx + m.yy), difference = 0.5 * (m.xx - m.yy);
  return half + square_root(difference * difference + m.xy * m.xy);
}
/// a times a. The terms are added in the order of Eigen's product, of which this was one: masses keep their bits.
template <class V>
inline __attribute__((always_inline)) void square(const V (&a)[3][3], V (&of)[3][3]) {
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 2; ++i) of[i][j] = (a[i][0] * a[0][j] + a[i][1] * a[1][j]) + a[i][2] * a[2][j];
    of[2][j] = a[2][0] * a[0][j] + (a[2][1] * a[1][j] + a[2][2] * a[2][j]);
  }
}
/// By numbers, two grains at a time (1,000 spheres 1.02 times as fast): 33 ns a grain one by one, 75 by matrices.
template <class V>
V largest_eigenvalue(const Symmetric<3, V>& m) {
  const V scale = m.xx + m.yy + m.zz, zero = V{};
  const V xx = m.xx / scale, xy = m.xy / scale, yy = m.yy / scale;
  const V xz = m.xz / scale, yz = m.yz / scale, zz = m.zz / scale;
  V two[3][3], four[3][3];
  square<V>({{xx, xy, xz}, {xy, yy, yz}, {xz, yz, zz}}, two);
  square<V>(two, four);
  const auto squared = [&](int i, int j) { return four[i][j] * four[i][j]; };
  const V one_half = (squared(0, 0) + squared(2, 0)) + (squared(1, 1) + squared(0, 2));
  const V other_half = (squared(1, 0) + squared(0, 1)) + (squared(2, 1) + squared(1, 2));
  const V norm = square_root((one_half + other_half) + squared(2, 2));
  const V largest = scale * square_root(square_root(norm));
  return scale > 0.0 ? largest : zero;
}

/// Of two matrices.
template <int D>
V2 largest_eigenvalues(const Symmetric<D>& a, const Symmetric<D>& b) {
  Symmetric<D, V2> both{{a.xx, b.xx}, {a.xy, b.xy}, {a.yy, b.yy}};
  if constexpr (D == 3) {
    both.xz = V2{a.xz, b.xz};
    both.yz = V2{a.yz, b.yz};
    both.zz = V2{a.zz, b.zz};
  }
  return largest_eigenvalue(both);
}

}  // namespace

}  // namespace rvelab
