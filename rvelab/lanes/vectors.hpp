// Vectors of three lane quantities, and what pair loops and contact laws do with them.
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

/// Three columns of a vector quantity.
template <class V>
struct Triple {
  V x, y, z;
};
template <class V>
inline __attribute__((always_inline)) V dot(const Triple<V>& a, const Triple<V>& b) {
  return a.x * b.x + (a.y * b.y + a.z * b.z);
}
template <class V>
inline __attribute__((always_inline)) Triple<V> cross(const Triple<V>& a, const Triple<V>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class V>
inline __attribute__((always_inline)) Triple<V> plus(const Triple<V>& a, V factor, const Triple<V>& b) {
  return {a.x + factor * b.x, a.y + factor * b.y, a.z + factor * b.z};
}
template <class V>
inline __attribute__((always_inline)) Triple<V> minus(const Triple<V>& a, V factor, const Triple<V>& b) {
  return {a.x - factor * b.x, a.y - factor * b.y, a.z - factor * b.z};
}
template <class V>
inline __attribute__((always_inline)) Triple<V> times(V factor, const Triple<V>& b) {
  return {factor * b.x, factor * b.y, factor * b.z};
}

/// `a` in the lanes where `held`, else `b`.
template <class Mask, class V>
inline __attribute__((always_inline)) Triple<V> chosen(Mask held, const Triple<V>& a, const Triple<V>& b) {
  return {held ? a.x : b.x, held ? a.y : b.y, held ? a.z : b.z};
}

/// Three columns of pair arrays.
template <class V>
inline __attribute__((always_inline)) Triple<V> load_triple(double* const* from, long at) {
  return {load_as<V>(from[0] + at), load_as<V>(from[1] + at), load_as<V>(from[2] + at)};
}
template <class V>
inline __attribute__((always_inline)) void store_triple(double* const* to, long at, const Triple<V>& value) {
  store_as(to[0] + at, value.x);
  store_as(to[1] + at, value.y);
  store_as(to[2] + at, value.z);
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
