// Powers over lanes, by + - * / and shifts of bits alone: the same bits on every machine and for every width.
//
// x^y = 2^(y log2 x). With x = 2^k m, m from sqrt(1/2) to sqrt(2), and s = (m - 1)/(m + 1), log2 m = s P(s^2); of y
// log2 x = i + f, f from -1/2 to 1/2, 2^f = 1 + f Q(f). P and Q are Chebyshev fits, to 4e-18 and 2e-17. What is left is
// the rounding of the logarithm: 2e-16 |y log2 x| of the power, so 2e-16 of 1 where x is at most 1 and y positive.
#pragma once

#include "rvelab/lanes/vectors.hpp"

namespace rvelab {
namespace {

/// As many integers as V has doubles.
template <class V>
struct BitsOf;
template <>
struct BitsOf<double> {
  using Type = std::uint64_t;
};
template <>
struct BitsOf<V2> {
  using Type = std::uint64_t __attribute__((vector_size(16)));
};
template <>
struct BitsOf<V4> {
  using Type = std::uint64_t __attribute__((vector_size(32)));
};
template <>
struct BitsOf<V8> {
  using Type = std::uint64_t __attribute__((vector_size(64)));
};
template <class To, class From>
inline __attribute__((always_inline)) To same_bits(From from) {
  static_assert(sizeof(To) == sizeof(From));
  To to;
  std::memcpy(&to, &from, sizeof(To));
  return to;
}

/// Of a normal positive number.
template <class V>
inline __attribute__((always_inline)) V log2_of(V x) {
  using Bits = typename BitsOf<V>::Type;
  constexpr std::uint64_t root_half = 0x3fe6a09e667f3bcd, mantissa = 0x000fffffffffffff, magic = 0x4330000000000000;
  const Bits from_root = same_bits<Bits>(x) - (root_half - 0x4000000000000000);
  const V k = same_bits<V>((from_root >> 52) | magic) - (4503599627370496.0 + 1024.0);  // k + 1024 ends 2^52
  const V m = same_bits<V>((from_root & mantissa) + root_half);
  const V s = (m - 1.0) / (m + 1.0), z = s * s, zz = z * z;
  const V low =
      (2.8853900817779268115 + 0.96179669392598973881 * z) + (0.57707801634551408177 + 0.41219858584229418696 * z) * zz;
  const V high = (0.32059853476504814154 + 0.26233436060329547249 * z) +
                 (0.22091286734180157085 + 0.21366122502798327273 * z) * zz;
  return k + s * (low + (zz * zz) * high);
}

/// Of -1000 to 1000.
template <class V>
inline __attribute__((always_inline)) V exp2_of(V y) {
  using Bits = typename BitsOf<V>::Type;
  constexpr double magic = 6755399441055744.0;  // 1.5 2^52: sums end in the nearest integer
  const V sum = y + magic;
  const V f = y - (sum - magic), ff = f * f, f4 = ff * ff;
  const V low = (0.69314718055994530942 + 0.2402265069591009822 * f) +
                (0.055504108664821594339 + 0.0096181291076068885273 * f) * ff;
  const V middle = (0.001333355814641693531 + 0.00015403530441736050155 * f) +
                   (0.000015252733829836118394 + 1.3215442587921689653e-6 * f) * ff;
  const V high = (1.0178062445845773521e-7 + 7.0725859492692236999e-9 * f) + 4.4549605981865183938e-10 * ff;
  const V power = 1.0 + f * (low + f4 * (middle + f4 * high));
  return same_bits<V>(same_bits<Bits>(power) + (same_bits<Bits>(sum) << 52));
}

/// x^y of a normal positive x; |y log2 x| up to 1000.
template <class V>
inline __attribute__((always_inline)) V power_of(V x, V y) {
  return exp2_of<V>(y * log2_of<V>(x));
}

}  // namespace
}  // namespace rvelab
