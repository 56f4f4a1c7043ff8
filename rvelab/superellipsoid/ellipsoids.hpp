// Superellipsoids with exponents of 2, without powers: h(n) = sqrt(n.M n), M = sum a^2 e e over the axes, the point M
// n/h, the radii of curvature C = (M - M n M n/h^2)/h. Nothing is flat, so Newton's steps alone lead to the least f
// (overlap.hpp): from the normal of the ellipsoid of M_i + M_j where the branch leaves it.
#pragma once

#include "rvelab/superellipsoid/lanes.hpp"

namespace rvelab {
namespace {

/// M, m^2; the least radius of curvature, c^2/a of the shortest and longest half axis, m.
template <class V>
struct EllipsoidMatrix {
  V xx, yy, zz, yz, xz, xy, rolling;
};
template <class V>
inline __attribute__((always_inline)) EllipsoidMatrix<V> ellipsoid_matrix(const Triple<V>& half,
                                                                          const SuperellipsoidAxes<V>& e) {
  const V aa = half.x * half.x, bb = half.y * half.y, cc = half.z * half.z;
  const auto sum = [&](V x, V y, V z) { return aa * x + (bb * y + cc * z); };
  const auto smaller = [](V p, V q) { return p < q ? p : q; };
  return {sum(e.x.x * e.x.x, e.y.x * e.y.x, e.z.x * e.z.x),
          sum(e.x.y * e.x.y, e.y.y * e.y.y, e.z.y * e.z.y),
          sum(e.x.z * e.x.z, e.y.z * e.y.z, e.z.z * e.z.z),
          sum(e.x.y * e.x.z, e.y.y * e.y.z, e.z.y * e.z.z),
          sum(e.x.x * e.x.z, e.y.x * e.y.z, e.z.x * e.z.z),
          sum(e.x.x * e.x.y, e.y.x * e.y.y, e.z.x * e.z.y),
          smaller(aa, smaller(bb, cc)) / larger_of(half.x, larger_of(half.y, half.z))};
}
template <class V>
inline __attribute__((always_inline)) Triple<V> times(const EllipsoidMatrix<V>& m, const Triple<V>& v) {
  return {m.xx * v.x + (m.xy * v.y + m.xz * v.z), m.xy * v.x + (m.yy * v.y + m.yz * v.z),
          m.xz * v.x + (m.yz * v.y + m.zz * v.z)};
}

/// Along M^-1 v: rows of the cofactors.
template <class V>
inline __attribute__((always_inline)) Triple<V> along_inverse(const EllipsoidMatrix<V>& m, const Triple<V>& v) {
  const V c11 = m.yy * m.zz - m.yz * m.yz, c22 = m.xx * m.zz - m.xz * m.xz, c33 = m.xx * m.yy - m.xy * m.xy;
  const V c23 = m.xy * m.xz - m.xx * m.yz, c13 = m.xy * m.yz - m.yy * m.xz, c12 = m.xz * m.yz - m.xy * m.zz;
  return {c11 * v.x + (c12 * v.y + c13 * v.z), c12 * v.x + (c22 * v.y + c23 * v.z),
          c13 * v.x + (c23 * v.y + c33 * v.z)};
}

/// The support of one along n of length 1.
template <class V>
struct EllipsoidAt {
  V height, inverse;  ///< h, 1/h
  Triple<V> point;
};
template <class V>
inline __attribute__((always_inline)) EllipsoidAt<V> ellipsoid_at(const EllipsoidMatrix<V>& m, const Triple<V>& n) {
  const Triple<V> mn = times(m, n);
  const V h = square_root(dot(n, mn)), inverse = 1.0 / h;
  return {h, inverse, times(inverse, mn)};
}
/// C t.
template <class V>
inline __attribute__((always_inline)) Triple<V> bent(const EllipsoidMatrix<V>& m, const EllipsoidAt<V>& at,
                                                     const Triple<V>& t) {
  return times(at.inverse, plus(times(m, t), -dot(at.point, t), at.point));
}

/// Two vectors of length 1 across n.
template <class V>
inline __attribute__((always_inline)) void across(const Triple<V>& n, Triple<V>& first, Triple<V>& second) {
  const V one = V{} + 1.0, sign = (n.z < 0.0) ? -one : one, a = -1.0 / (sign + n.z), b = n.x * n.y * a;
  first = {1.0 + sign * (n.x * n.x * a), sign * b, -(sign * n.x)};
  second = {b, sign + n.y * n.y * a, -n.y};
}

/// Two ellipsoids and the branch from i to j; what the search takes if it is asked.
template <class V>
struct EllipsoidPair {
  EllipsoidMatrix<V> i, j;
  Triple<V> branch;
};

/// `search`: the contact of one lane by superellipsoids.
template <class V, class Search>
inline __attribute__((always_inline)) ContactsOf<V> contacts_of(const EllipsoidPair<V>& pair, const Search& search) {
  const EllipsoidMatrix<V>&mi = pair.i, &mj = pair.j;
  const EllipsoidMatrix<V> sum = {mi.xx + mj.xx, mi.yy + mj.yy, mi.zz + mj.zz,          mi.yz + mj.yz,
                                  mi.xz + mj.xz, mi.xy + mj.xy, mi.rolling + mj.rolling};
  const V most = 0.9 * sum.rolling;
  Triple<V> n = of_length_1(along_inverse(sum, pair.branch)), first, second, turn;
  EllipsoidAt<V> i, j;
  V overlap, gain;
  auto done = most < 0.0, apart = done;
  ContactsOf<V> contacts;
  for (int k = 0; k <= superellipsoid_steps; ++k) {
    i = ellipsoid_at(mi, n);
    j = ellipsoid_at(mj, n);
    overlap = (i.height + j.height) - dot(n, pair.branch);
    across(n, first, second);
    const Triple<V> slope = plus(plus(pair.branch, V{} - 1.0, i.point), V{} - 1.0, j.point);
    const V F1 = dot(slope, first), F2 = dot(slope, second), shift = (overlap < most) ? overlap : most;
    const Triple<V> i1 = bent(mi, i, first), i2 = bent(mi, i, second), j1 = bent(mj, j, first),
                    j2 = bent(mj, j, second);
    const V a11 = dot(first, i1), a12 = dot(first, i2), a22 = dot(second, i2);
    const V b11 = dot(first, j1), b12 = dot(first, j2), b22 = dot(second, j2);
    const V c11 = (a11 + b11) - shift, c12 = a12 + b12, c22 = (a22 + b22) - shift;
    const V inverse = 1.0 / (c11 * c22 - c12 * c12);
    const V y1 = (c22 * F1 - c12 * F2) * inverse, y2 = (c11 * F2 - c12 * F1) * inverse, square = y1 * y1 + y2 * y2;
    turn = plus(times(y1, first), y2, second);
    gain = y1 * F1 + y2 * F2;
    apart = overlap < -1e-12 * (i.height + j.height);
    done = done | apart | (square <= 2.5e-9);
    if (k == superellipsoid_steps || !any_of(!done)) {
      contacts.radii_i = {a11 + a22, a11 * a22 - a12 * a12};
      contacts.radii_j = {b11 + b22, b11 * b22 - b12 * b12};
      const Triple<V> move_i = plus(times(y1, i1), y2, i2), move_j = plus(times(y1, j1), y2, j2);
      const Triple<V> both = plus(plus(i.point, V{} - 1.0, j.point), V{} + 1.0, pair.branch);
      contacts.point = times(V{} + 0.5, plus(plus(both, V{} + 1.0, move_i), V{} - 1.0, move_j));
      break;
    }
    n = chosen(done, n, turned_by(n, turn));
  }
  contacts.overlap = overlap - (apart ? V{} : 0.5 * gain);
  contacts.n = turned_by(n, turn);
  const auto left = !(apart | (done & (overlap <= sum.rolling)));
  if (any_of(left)) ask_search(left, contacts, search);
  return contacts;
}

}  // namespace
}  // namespace rvelab
