// What the grain loops of discs and spheres share. They gather the force rows of each grain's pairs in the order of the
// pairs, damp, integrate, move.
//
//   v' <- P (v' - mean) + R dt (f - damping)/m      P, R from D + 2 Omega at dt > 0, the identity at dt = 0
//   w' <- w' + dt T/I (+ frame terms at dt > 0)
//   x  <- A x + dt B v'                             A, B upper triangular, A = L1 L0^-1 exactly
// (solver/README.md). Sums over grains go into eight interleaved partial sums whatever the number of lanes, so that
// every instruction set adds in the same order.
#pragma once

#include "rvelab/solver/kernels/pairs.hpp"

namespace rvelab {
namespace {

template <int W_, bool Rolling_, bool AtRate_, KernelDamping damping_>
struct GrainTraits {
  static constexpr int W = W_;
  static constexpr bool Rolling = Rolling_, AtRate = AtRate_;
  static constexpr KernelDamping damping = damping_;
};

/// Eight partial sums, filled W at a time; total() adds them in a fixed order. Loops over grains go by eights, so that
/// the part is known when compiled and the sums stay in registers.
template <int W>
struct PartialSums {
  using V = typename Lanes<W>::V;
  V part[8 / W] = {};
  inline __attribute__((always_inline)) void add(int which, V value) { part[which] = part[which] + value; }
  double total() const {
    double values[8];
    std::memcpy(values, part, sizeof(values));
    return ((values[0] + values[4]) + (values[2] + values[6])) + ((values[1] + values[5]) + (values[3] + values[7]));
  }
};

/// Largest of the lanes; the order cannot matter.
template <class V>
inline double largest_of(V v) {
  double values[sizeof(V) / sizeof(double)];
  std::memcpy(values, &v, sizeof(V));
  double largest = values[0];
  for (double value : values) largest = value > largest ? value : largest;
  return largest;
}

/// A row of four doubles for every task of a chunk (GrainArrays): grains as j, then grains as i.
struct alignas(64) TaskRows {
  double at[8 * chunk_grains];
  inline __attribute__((always_inline)) double* of(std::uint16_t task) { return at + task; }
  inline __attribute__((always_inline)) const double* as_j(long k) const { return at + 4 * k; }
  inline __attribute__((always_inline)) const double* as_i(long k) const { return at + 4 * (chunk_grains + k); }
};

/// Four doubles, of which zeros are left.
template <int W>
inline __attribute__((always_inline)) typename Lanes<W>::Quad taken(double* from) {
  const auto value = quad_at<W>(from);
  store_as(from, Lanes<W>::broadcast(0.0));
  return value;
}

}  // namespace
}  // namespace rvelab
