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

/// Where to begin: the normal of the ellipsoid of M_i + M_j where the branch leaves it.
template <class V>
inline __attribute__((always_inline)) Triple<V> first_direction(const EllipsoidPair<V>& pair) {
  const EllipsoidMatrix<V>&i = pair.i, &j = pair.j;
  const EllipsoidMatrix<V> sum = {i.xx + j.xx, i.yy + j.yy, i.zz + j.zz, i.yz + j.yz,
                                  i.xz + j.xz, i.xy + j.xy, i.rolling};
  return of_length_1(along_inverse(sum, pair.branch));
}

/// f along a direction and Newton's step from there.
template <class V>
struct EllipsoidStep {
  EllipsoidAt<V> i, j;
  V overlap, gain, square;         ///< f; twice what it falls by the step; the turn, squared
  Triple<V> turn, move_i, move_j;  ///< of n, and of the points along their surfaces
  RadiiOfCurvature<V> radii_i, radii_j;
};
template <class V>
inline __attribute__((always_inline)) EllipsoidStep<V> ellipsoid_step(const EllipsoidPair<V>& pair,
                                                                      const Triple<V>& n) {
  const EllipsoidMatrix<V>&mi = pair.i, &mj = pair.j;
  const V most = 0.9 * (mi.rolling + mj.rolling);
  EllipsoidStep<V> step;
  step.i = ellipsoid_at(mi, n);
  step.j = ellipsoid_at(mj, n);
  step.overlap = (step.i.height + step.j.height) - dot(n, pair.branch);
  Triple<V> first, second;
  across(n, first, second);
  const Triple<V> slope = plus(plus(pair.branch, V{} - 1.0, step.i.point), V{} - 1.0, step.j.point);
  const V F1 = dot(slope, first), F2 = dot(slope, second), shift = (step.overlap < most) ? step.overlap : most;
  const Triple<V> i1 = bent(mi, step.i, first), i2 = bent(mi, step.i, second), j1 = bent(mj, step.j, first),
                  j2 = bent(mj, step.j, second);
  const V a11 = dot(first, i1), a12 = dot(first, i2), a22 = dot(second, i2);
  const V b11 = dot(first, j1), b12 = dot(first, j2), b22 = dot(second, j2);
  const V c11 = (a11 + b11) - shift, c12 = a12 + b12, c22 = (a22 + b22) - shift;
  const V inverse = 1.0 / (c11 * c22 - c12 * c12);
  const V y1 = (c22 * F1 - c12 * F2) * inverse, y2 = (c11 * F2 - c12 * F1) * inverse;
  step.square = y1 * y1 + y2 * y2;
  step.turn = plus(times(y1, first), y2, second);
  step.gain = y1 * F1 + y2 * F2;
  step.move_i = plus(times(y1, i1), y2, i2);
  step.move_j = plus(times(y1, j1), y2, j2);
  step.radii_i = {a11 + a22, a11 * a22 - a12 * a12};
  step.radii_j = {b11 + b22, b11 * b22 - b12 * b12};
  return step;
}
template <class V>
inline __attribute__((always_inline)) auto is_apart(const EllipsoidStep<V>& step) {
  return step.overlap < -1e-12 * (step.i.height + step.j.height);
}
/// Whether a pair is apart, or the step leads to the least: f to the third power of it.
template <class V>
inline __attribute__((always_inline)) auto is_done(const EllipsoidStep<V>& step) {
  return is_apart(step) | (step.square <= 2.5e-9);
}

/// What a contact is from where the last step leads to it. `search`: the contact of one lane by superellipsoids.
template <class V, class Search>
inline __attribute__((always_inline)) ContactsOf<V> contacts_by(const EllipsoidPair<V>& pair, const Triple<V>& n,
                                                                const EllipsoidStep<V>& step, const Search& search) {
  const auto apart = is_apart(step);
  ContactsOf<V> contacts;
  const Triple<V> both = plus(plus(step.i.point, V{} - 1.0, step.j.point), V{} + 1.0, pair.branch);
  contacts.overlap = step.overlap - (apart ? V{} : 0.5 * step.gain);
  contacts.n = turned_by(n, step.turn);
  contacts.point = times(V{} + 0.5, plus(plus(both, V{} + 1.0, step.move_i), V{} - 1.0, step.move_j));
  contacts.radii_i = step.radii_i;
  contacts.radii_j = step.radii_j;
  const auto left = !(apart | (is_done(step) & (step.overlap <= pair.i.rolling + pair.j.rolling)));
  if (any_of(left)) ask_search(left, contacts, search);
  return contacts;
}

template <class V, class Search>
inline __attribute__((always_inline)) ContactsOf<V> contacts_of(const EllipsoidPair<V>& pair, const Search& search) {
  Triple<V> n = first_direction(pair);
  EllipsoidStep<V> step = ellipsoid_step(pair, n);
  for (int k = 0; k < superellipsoid_steps && any_of(!is_done(step)); ++k) {
    n = chosen(is_done(step), n, turned_by(n, step.turn));
    step = ellipsoid_step(pair, n);
  }
  return contacts_by(pair, n, step, search);
}

}  // namespace
}  // namespace rvelab
