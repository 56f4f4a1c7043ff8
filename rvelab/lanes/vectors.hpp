// Vectors of lane quantities in the plane and in space, and what pair loops and contact laws do with them.
#pragma once

#include "rvelab/lanes/lanes.hpp"

namespace rvelab {
namespace {

/// |v|, by its sign bit alone.
inline __attribute__((always_inline)) double magnitude_of(double v) { return __builtin_fabs(v); }
template <class V>
inline __attribute__((always_inline)) V magnitude_of(V v) {
  using Bits = decltype(v < v);
  return (V)((Bits)v & (Bits{} + INT64_MAX));
}

/// v between -limit and limit, limit >= 0; in the forms that compile to one instruction each.
template <class V>
inline __attribute__((always_inline)) V clamped(V v, V limit) {
  const V least = -limit;
  const V raised = (v > least) ? v : least;
  return (raised < limit) ? raised : limit;
}

/// D columns of a vector quantity, two or three. In the plane spins and moments are one column, V itself: sums,
/// products and damping take both.
template <class V, int D>
struct Vec;
template <class V>
struct Vec<V, 2> {
  V x, y;
};
template <class V>
struct Vec<V, 3> {
  V x, y, z;
};
template <class V>
using Triple = Vec<V, 3>;

template <class V>
inline __attribute__((always_inline)) V dot(V a, V b) {
  return a * b;
}
template <class V, int D>
inline __attribute__((always_inline)) V dot(const Vec<V, D>& a, const Vec<V, D>& b) {
  if constexpr (D == 2)
    return a.x * b.x + a.y * b.y;
  else
    return a.x * b.x + (a.y * b.y + a.z * b.z);
}
template <class V>
inline __attribute__((always_inline)) Triple<V> cross(const Triple<V>& a, const Triple<V>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class V, int D>
inline __attribute__((always_inline)) Vec<V, D> operator+(const Vec<V, D>& a, const Vec<V, D>& b) {
  if constexpr (D == 2)
    return {a.x + b.x, a.y + b.y};
  else
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class V, int D>
inline __attribute__((always_inline)) Vec<V, D> operator-(const Vec<V, D>& a, const Vec<V, D>& b) {
  if constexpr (D == 2)
    return {a.x - b.x, a.y - b.y};
  else
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
/// `factor`: one for all lanes or one for each.
template <class Factor, class V>
inline __attribute__((always_inline)) V times(Factor factor, V a) {
  return factor * a;
}
template <class Factor, class V, int D>
inline __attribute__((always_inline)) Vec<V, D> times(Factor factor, const Vec<V, D>& a) {
  if constexpr (D == 2)
    return {factor * a.x, factor * a.y};
  else
    return {factor * a.x, factor * a.y, factor * a.z};
}
template <class V, class Factor>
inline __attribute__((always_inline)) V plus(V a, Factor factor, V b) {
  return a + factor * b;
}
template <class V, int D, class Factor>
inline __attribute__((always_inline)) Vec<V, D> plus(const Vec<V, D>& a, Factor factor, const Vec<V, D>& b) {
  return a + times(factor, b);
}
template <class V, int D, class Factor>
inline __attribute__((always_inline)) Vec<V, D> minus(const Vec<V, D>& a, Factor factor, const Vec<V, D>& b) {
  return a - times(factor, b);
}

/// `a` in the lanes where `held`, else `b`.
template <class Mask, class V, int D>
inline __attribute__((always_inline)) Vec<V, D> chosen(Mask held, const Vec<V, D>& a, const Vec<V, D>& b) {
  if constexpr (D == 2)
    return {held ? a.x : b.x, held ? a.y : b.y};
  else
    return {held ? a.x : b.x, held ? a.y : b.y, held ? a.z : b.z};
}

/// D columns of arrays.
template <class V, int D = 3, class Number>
inline __attribute__((always_inline)) Vec<V, D> load_vec(Number* const* from, long at) {
  if constexpr (D == 2)
    return {load_as<V>(from[0] + at), load_as<V>(from[1] + at)};
  else
    return {load_as<V>(from[0] + at), load_as<V>(from[1] + at), load_as<V>(from[2] + at)};
}
template <class V, int D>
inline __attribute__((always_inline)) void store_vec(double* const* to, long at, const Vec<V, D>& value) {
  store_as(to[0] + at, value.x);
  store_as(to[1] + at, value.y);
  if constexpr (D == 3) store_as(to[2] + at, value.z);
}

/// The first D of some columns.
template <int D, class V>
inline __attribute__((always_inline)) Vec<V, D> first_of(const V* columns) {
  if constexpr (D == 2)
    return {columns[0], columns[1]};
  else
    return {columns[0], columns[1], columns[2]};
}
/// The first three of four doubles of rows that follow each other, `stride` apart; and back to such rows, with a
/// fourth.
template <int W>
inline __attribute__((always_inline)) Triple<typename Lanes<W>::V> triple_of(const double* rows, long stride) {
  typename Lanes<W>::V columns[4];
  columns_of<W>(rows, stride, columns);
  return first_of<3>(columns);
}
template <int W>
inline __attribute__((always_inline)) void rows_of(const Triple<typename Lanes<W>::V>& v, typename Lanes<W>::V fourth,
                                                   double* row, long stride) {
  const typename Lanes<W>::V columns[4] = {v.x, v.y, v.z, fourth};
  rows_of<W>(columns, row, stride);
}

/// A history vector in the tangent plane of the new normal, turned about n by the mean spin times dt (first order), and
/// the factor that brings it back to its old length.
template <class V>
struct TurnedHistory {
  Triple<V> vector;
  V factor;
};
template <class V>
inline __attribute__((always_inline)) TurnedHistory<V> turned_history(const Triple<V>& history, const Triple<V>& n,
                                                                      V angle, bool twist) {
  const V one = V{} + 1.0;
  const V before = dot(history, history);
  Triple<V> h = plus(history, -dot(history, n), n);
  if (twist) h = plus(h, angle, cross(n, h));
  const V after = dot(h, h);
  const V factor = square_root(before / ((after > 0.0) ? after : one));
  return {h, (after > 0.0) ? factor : V{}};
}

}  // namespace
}  // namespace rvelab
