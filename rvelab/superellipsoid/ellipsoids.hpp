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
inline EllipsoidMatrix<double> in_lane(const EllipsoidMatrix<V>& m, int lane) {
  return {in_lane(m.xx, lane), in_lane(m.yy, lane), in_lane(m.zz, lane),     in_lane(m.yz, lane),
          in_lane(m.xz, lane), in_lane(m.xy, lane), in_lane(m.rolling, lane)};
}
template <class V>
inline __attribute__((always_inline)) EllipsoidMatrix<V> ellipsoid_matrix(const Triple<V>& half,
                                                                          const SuperellipsoidAxes<V>& e) {
  const V aa = half.x * half.x, bb = half.y * half.y, cc = half.z * half.z;
  const auto smaller = [](V p, V q) { return p < q ? p : q; };
  const Triple<V> x = times(aa - cc, e.x), y = times(bb - cc, e.y);  // the squares of the axes sum up to 1
  return {cc + (x.x * e.x.x + y.x * e.y.x),
          cc + (x.y * e.x.y + y.y * e.y.y),
          cc + (x.z * e.x.z + y.z * e.y.z),
          x.y * e.x.z + y.y * e.y.z,
          x.x * e.x.z + y.x * e.y.z,
          x.x * e.x.y + y.x * e.y.y,
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
/// The product is that of the squares of the half axes over h^4.
template <class V>
inline __attribute__((always_inline)) RadiiOfCurvature<V> radii_of_curvature(const EllipsoidMatrix<V>& m,
                                                                             const EllipsoidAt<V>& at) {
  const V determinant =
      m.xx * (m.yy * m.zz - m.yz * m.yz) + m.xy * (m.xz * m.yz - m.xy * m.zz) + m.xz * (m.xy * m.yz - m.yy * m.xz);
  const V squared = at.height * at.height;
  return {at.inverse * ((m.xx + (m.yy + m.zz)) - dot(at.point, at.point)), determinant / (squared * squared)};
}

/// Two ellipsoids and the branch from i to j; what the search takes if it is asked.
template <class V>
struct EllipsoidPair {
  EllipsoidMatrix<V> i, j;
  Triple<V> branch;
};

/// Of two that touch where n is normal to both (support.hpp). det C = det M/h^4; det(C_i + C_j) the sum of the
/// principal minors, since the third principal value, along n, is 0.
template <class V>
inline __attribute__((always_inline)) V hertz_radius(const EllipsoidPair<V>& pair, const Triple<V>& n) {
  const EllipsoidMatrix<V>&mi = pair.i, &mj = pair.j;
  const EllipsoidAt<V> i = ellipsoid_at(mi, n), j = ellipsoid_at(mj, n);
  const V own_i = radii_of_curvature(mi, i).product, own_j = radii_of_curvature(mj, j).product;
  const Triple<V>&xi = i.point, &xj = j.point;
  const auto radii = [&](V m_i, V m_j, V of_i, V of_j) { return i.inverse * (m_i - of_i) + j.inverse * (m_j - of_j); };
  const V xx = radii(mi.xx, mj.xx, xi.x * xi.x, xj.x * xj.x), yy = radii(mi.yy, mj.yy, xi.y * xi.y, xj.y * xj.y);
  const V zz = radii(mi.zz, mj.zz, xi.z * xi.z, xj.z * xj.z), yz = radii(mi.yz, mj.yz, xi.y * xi.z, xj.y * xj.z);
  const V xz = radii(mi.xz, mj.xz, xi.x * xi.z, xj.x * xj.z), xy = radii(mi.xy, mj.xy, xi.x * xi.y, xj.x * xj.y);
  const V both = (xx * yy - xy * xy) + ((xx * zz - xz * xz) + (yy * zz - yz * yz));
  return square_root(own_i * own_j / both);
}

/// Where to begin: the normal of the ellipsoid of M_i + M_j where the branch leaves it.
template <class V>
inline __attribute__((always_inline)) Triple<V> first_direction(const EllipsoidPair<V>& pair) {
  const EllipsoidMatrix<V>&i = pair.i, &j = pair.j;
  const EllipsoidMatrix<V> sum = {i.xx + j.xx, i.yy + j.yy, i.zz + j.zz, i.yz + j.yz,
                                  i.xz + j.xz, i.xy + j.xy, i.rolling};
  return of_length_1(along_inverse(sum, pair.branch));
}

/// f along a direction and Newton's step from there: with K = C_i + C_j, which is 0 along n, the turn is
/// ((tr K - s) F - K F)/det, det = p - s (tr K - s), p the sum of the principal minors of K. From where it leads a
/// second one by the same K, so that less is left for places to differ by: the tangent was 7 % off without
/// (test_solids).
template <class V>
struct EllipsoidStep {
  V height, least;                    ///< h_i + h_j, f
  Triple<V> along, by;                ///< n, the turn
  EllipsoidAt<V> i, j;                ///< where it leads
  V there, shift;                     ///< f there, s
  Triple<V> then, downhill, further;  ///< n there, F, the second turn

  V overlap() const { return least; }
  V heights() const { return height; }
  const Triple<V>& n() const { return along; }
  const Triple<V>& turn() const { return by; }
  V reach() const { return V{}; }
  Triple<V> next() const { return turned_by(then, further); }
};
template <class V>
struct SeenOfPair<EllipsoidPair<V>> {
  using Type = EllipsoidStep<V>;
};
template <class V>
inline __attribute__((always_inline)) V rolling_of(const EllipsoidPair<V>& pair) {
  return pair.i.rolling + pair.j.rolling;
}
template <class V>
inline __attribute__((always_inline)) void evaluate(const EllipsoidPair<V>& pair, const Triple<V>& n,
                                                    EllipsoidStep<V>& step) {
  const EllipsoidMatrix<V>&mi = pair.i, &mj = pair.j;
  step.along = n;
  const EllipsoidAt<V> i = ellipsoid_at(mi, n), j = ellipsoid_at(mj, n);
  step.height = i.height + j.height;
  step.least = step.height - dot(n, pair.branch);
  const V minus = V{} - 1.0, most = 0.9 * rolling_of(pair), hi = i.inverse, hj = j.inverse;
  const Triple<V>&xi = i.point, &xj = j.point, ui = times(hi, xi), uj = times(hj, xj);
  const auto slope = [&](const EllipsoidAt<V>& a, const EllipsoidAt<V>& b, V f, const Triple<V>& along) {
    return plus(plus(plus(pair.branch, minus, a.point), minus, b.point), f, along);
  };
  step.shift = (step.least < most) ? step.least : most;
  const auto curved = [&](V m_i, V m_j, V of_i, V of_j) { return (hi * m_i + hj * m_j) - (of_i + of_j); };
  const EllipsoidMatrix<V> K = {curved(mi.xx, mj.xx, ui.x * xi.x, uj.x * xj.x),
                                curved(mi.yy, mj.yy, ui.y * xi.y, uj.y * xj.y),
                                curved(mi.zz, mj.zz, ui.z * xi.z, uj.z * xj.z),
                                curved(mi.yz, mj.yz, ui.y * xi.z, uj.y * xj.z),
                                curved(mi.xz, mj.xz, ui.x * xi.z, uj.x * xj.z),
                                curved(mi.xy, mj.xy, ui.x * xi.y, uj.x * xj.y),
                                V{}};
  const V rest = (K.xx + (K.yy + K.zz)) - step.shift;
  const V minors = (K.xx * K.yy - K.xy * K.xy) + ((K.xx * K.zz - K.xz * K.xz) + (K.yy * K.zz - K.yz * K.yz));
  const V inverse = 1.0 / (minors - step.shift * rest);
  const auto turn_of = [&](const Triple<V>& F) { return times(inverse, plus(times(rest, F), minus, times(K, F))); };
  step.by = turn_of(slope(i, j, step.least, n));
  step.then = turned_by(n, step.by);
  step.i = ellipsoid_at(mi, step.then);
  step.j = ellipsoid_at(mj, step.then);
  step.there = (step.i.height + step.j.height) - dot(step.then, pair.branch);
  step.downhill = slope(step.i, step.j, step.there, step.then);
  step.further = turn_of(step.downhill);
}
/// Nothing is flat: Newton's step is good from afar.
template <class V>
inline __attribute__((always_inline)) Triple<V> far_direction(const EllipsoidPair<V>& pair, const Triple<V>& n) {
  EllipsoidStep<V> step;
  evaluate(pair, n, step);
  return turned_by(n, step.by);
}
/// Aspects of 1:10, many times over.
template <class V>
inline __attribute__((always_inline)) V noise_of(const EllipsoidPair<V>&) {
  return V{} + 1e-12;
}
template <class V>
inline __attribute__((always_inline)) auto place_of(const EllipsoidPair<V>& pair, const Triple<V>& n,
                                                    const EllipsoidStep<V>& step) {
  const V s = V{} + widest_place, turn = most_of(step.by), error = turn * (90.0 * turn) + noise_of(pair);
  GridPlace<V, decltype(s < turn)> place = {rounded_to(n, s), s, s < turn, s < 0.0};
  place.sure = most_of(plus(n, V{} - 1.0, place.at)) + error < 0.5 * s;
  return place;
}

/// What a contact is from where the last step leads to it.
template <class V>
inline __attribute__((always_inline)) ContactsOf<V> contacts_by(const EllipsoidPair<V>& pair,
                                                                const EllipsoidStep<V>& step) {
  // The points go by C_i y and C_j y = F + s y - C_i y.
  const V one = V{} + 1.0;
  const Triple<V> both = plus(plus(step.i.point, -one, step.j.point), one, pair.branch);
  const Triple<V> turned = plus(plus(both, -one, step.downhill), -step.shift, step.further);
  return {step.there - 0.5 * dot(step.further, step.downhill), step.next(),
          times(V{} + 0.5, plus(turned, V{} + 2.0, bent(pair.i, step.i, step.further)))};
}

/// From the bodies alone. `search`: the contact of one lane by superellipsoids, from its number.
template <class V, class Search>
__attribute__((noinline)) void from_bodies(const EllipsoidPair<V>& pair, ContactsOf<V>& contacts, Triple<V>& next,
                                           const Search& search) {
  next = first_direction(pair);
  const auto led = led_from(pair, next, superellipsoid_steps);
  contacts = contacts_by(pair, led.seen);
  contacts.overlap = led.look.apart ? V{} - 1.0 : contacts.overlap;
  const decltype(V{} < 0.0) left = !(led.look.apart | led.look.final);
  if (!any_of(left)) return;
  ask_search(left, contacts, [&](int lane) {
    const ContactsOf<double> found = search(lane);
    const EllipsoidPair<double> one = {in_lane(pair.i, lane), in_lane(pair.j, lane), in_lane(pair.branch, lane)};
    Triple<double> place = found.n;
    const auto last = led_from(one, place, 3);
    return last.look.final ? contacts_by(one, last.seen) : found;
  });
  next = chosen(left, contacts.n, next);
}

/// `guess` as of superellipsoids.
template <class V, class Search>
inline __attribute__((always_inline)) ContactsOf<V> contacts_of(const EllipsoidPair<V>& pair, Triple<V>& guess,
                                                                const Search& search) {
  using Mask = decltype(V{} < 0.0);
  const Mask none = dot(guess, guess) < 0.25;
  if (any_of(none)) guess = chosen(none, first_direction(pair), guess);
  const auto led = led_from(pair, guess, steps_from_guess);
  ContactsOf<V> contacts = contacts_by(pair, led.seen);
  contacts.overlap = led.look.apart ? V{} - 1.0 : contacts.overlap;
  const Mask left = !(led.look.apart | led.look.final);
  if (any_of(left)) {
    ContactsOf<V> others;
    Triple<V> next;
    from_bodies(pair, others, next, search);
    contacts = chosen(left, others, contacts);
    guess = chosen(left, next, guess);
  }
  return contacts;
}

}  // namespace
}  // namespace rvelab
