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
inline __attribute__((always_inline)) Triple<V> times(V factor, const Triple<V>& b) {
  return {factor * b.x, factor * b.y, factor * b.z};
}

/// `a` in the lanes where `held`, else `b`.
template <class Mask, class V>
inline __attribute__((always_inline)) Triple<V> chosen(Mask held, const Triple<V>& a, const Triple<V>& b) {
  return {held ? a.x : b.x, held ? a.y : b.y, held ? a.z : b.z};
}

}  // namespace
}  // namespace rvelab
