// Turns of rigid bodies over lanes, or of one: unit quaternions, principal axes, the free top (rigid_motion.hpp says
// which rule).
// Every operation is one of its lane alone, so that lanes of every width give the same bits.
#pragma once

#include "rvelab/lanes/vectors.hpp"

namespace rvelab {
namespace {

/// Unit quaternions, body frames to cell frame.
template <class V>
struct LaneTurn {
  V w;
  Triple<V> v;
};

/// First b, then a.
template <class V>
inline __attribute__((always_inline)) LaneTurn<V> after(const LaneTurn<V>& a, const LaneTurn<V>& b) {
  const Triple<V> across = cross(a.v, b.v);
  return {a.w * b.w - dot(a.v, b.v),
          {(a.w * b.v.x + b.w * a.v.x) + across.x, (a.w * b.v.y + b.w * a.v.y) + across.y,
           (a.w * b.v.z + b.w * a.v.z) + across.z}};
}
/// First q, then the Cayley rotation of 2 t, whose quaternion is (1, t) over its length.
template <class V>
inline __attribute__((always_inline)) LaneTurn<V> turned_by(const Triple<V>& t, const LaneTurn<V>& q) {
  const Triple<V> across = cross(t, q.v);
  return {q.w - dot(t, q.v),
          {(q.v.x + q.w * t.x) + across.x, (q.v.y + q.w * t.y) + across.y, (q.v.z + q.w * t.z) + across.z}};
}
template <class V>
inline __attribute__((always_inline)) LaneTurn<V> normalised(const LaneTurn<V>& q) {
  const V scale = 1.0 / square_root(q.w * q.w + dot(q.v, q.v));
  return {scale * q.w, times(scale, q.v)};
}

/// The matrix of a turn, by rows; its columns are the principal axes.
template <class V>
struct LaneAxes {
  Triple<V> row[3];
};
template <class V>
inline __attribute__((always_inline)) LaneAxes<V> axes_of(const LaneTurn<V>& q) {
  const V x = q.v.x, y = q.v.y, z = q.v.z, w = q.w, two = V{} + 2.0, one = V{} + 1.0;
  return {{{one - two * (y * y + z * z), two * (x * y - w * z), two * (x * z + w * y)},
           {two * (x * y + w * z), one - two * (x * x + z * z), two * (y * z - w * x)},
           {two * (x * z - w * y), two * (y * z + w * x), one - two * (x * x + y * y)}}};
}
/// From the body frame to the cell frame, and back.
template <class V>
inline __attribute__((always_inline)) Triple<V> to_cell(const LaneAxes<V>& axes, const Triple<V>& a) {
  return {dot(axes.row[0], a), dot(axes.row[1], a), dot(axes.row[2], a)};
}
template <class V>
inline __attribute__((always_inline)) Triple<V> to_body(const LaneAxes<V>& axes, const Triple<V>& a) {
  const Triple<V>&x = axes.row[0], &y = axes.row[1], &z = axes.row[2];
  return {x.x * a.x + (y.x * a.y + z.x * a.z), x.y * a.x + (y.y * a.y + z.y * a.z),
          x.z * a.x + (y.z * a.y + z.z * a.z)};
}

template <class V>
inline __attribute__((always_inline)) Triple<V> by_axis(const Triple<V>& factors, const Triple<V>& a) {
  return {factors.x * a.x, factors.y * a.y, factors.z * a.z};
}

/// Free rotation for a time t: momentum in the body frame, which becomes that at the end. Returns t wm. A lane whose
/// iteration has settled keeps its value, whatever those beside it need.
template <class V>
inline __attribute__((always_inline)) Triple<V> rotate_freely(V t, const Triple<V>& inverse_moments,
                                                              Triple<V>& momentum) {
  constexpr int most_iterations = 60;  // of steps beyond all use; they end at the last bit long before
  const V half = 0.5 * t, one = V{} + 1.0;
  Triple<V> middle = momentum;
  auto unsettled = one > 0.0;
  for (int k = 0; k < most_iterations && any_of(unsettled); ++k) {
    const Triple<V> next = plus(momentum, half, cross(middle, by_axis(inverse_moments, middle)));
    const Triple<V> change = plus(next, -one, middle);
    const auto moves_on = dot(change, change) > 1e-32 * dot(next, next);
    middle = chosen(unsettled, next, middle);
    unsettled = unsettled & moves_on;
  }
  momentum = {2.0 * middle.x - momentum.x, 2.0 * middle.y - momentum.y, 2.0 * middle.z - momentum.z};
  return times(t, by_axis(inverse_moments, middle));
}

}  // namespace
}  // namespace rvelab
