// Lanes: the one place that knows how wide the machine's vectors are. A kernel is written once over Lanes<W>::V, W
// pairs or grains at a time; W = 1 is the plain scalar reference. Only + - * / sqrt, compare and select are used, each
// rounded once, so that every W gives the same bits.
//
// Quad is a row of four doubles, the unit in which grain rows are loaded: wider than the machine's vectors it would be
// taken apart element by element (8 times slower on SSE2), so two lanes keep it as two halves.
#pragma once

#include <cstdint>
#include <cstring>
#if defined(__SSE2__)
#include <immintrin.h>
#elif defined(__wasm_simd128__)
#include <wasm_simd128.h>
#endif

namespace rvelab {
namespace {

using V2 = double __attribute__((vector_size(16)));
using V4 = double __attribute__((vector_size(32)));
using V8 = double __attribute__((vector_size(64)));

/// Lanes<W>: V, W values side by side; Quad, four doubles of a grain or force row. Beside arithmetic on Quads:
/// `transpose` of W of them to four V and back, `transpose_pairs` of W halves to two V; `collected`, a V of W values;
/// `seen_from_i`, the force row {fx, fy, T_j, T_i} of a disc pair as grain i has it, {-fx, -fy, T_i, T_j}.
template <int W>
struct Lanes;

template <class V>
inline __attribute__((always_inline)) V load_as(const double* from) {
  V value;
  std::memcpy(&value, from, sizeof(V));
  return value;
}
template <class V>
inline __attribute__((always_inline)) void store_as(double* to, V value) {
  std::memcpy(to, &value, sizeof(V));
}

/// Whether a comparison held in any lane; a lane of a mask is all ones or zero.
inline __attribute__((always_inline)) bool any_of(bool held) { return held; }
template <class Mask>
inline __attribute__((always_inline)) bool any_of(Mask held) {
#if defined(__AVX512F__)
  if constexpr (sizeof(Mask) == 64) return _mm512_test_epi64_mask((__m512i)held, (__m512i)held) != 0;
#endif
#if defined(__AVX__)
  if constexpr (sizeof(Mask) == 32) return _mm256_movemask_pd((__m256d)held) != 0;
#endif
#if defined(__SSE2__)
  if constexpr (sizeof(Mask) == 16) return _mm_movemask_pd((__m128d)held) != 0;
#elif defined(__wasm_simd128__)
  if constexpr (sizeof(Mask) == 16) return wasm_v128_any_true((v128_t)held);
#endif
  std::int64_t lanes[sizeof(Mask) / sizeof(std::int64_t)], any = 0;
  std::memcpy(lanes, &held, sizeof(Mask));
  for (std::int64_t lane : lanes) any |= lane;
  return any != 0;
}

inline __attribute__((always_inline)) double square_root(double v) { return __builtin_sqrt(v); }
inline __attribute__((always_inline)) V2 square_root(V2 v) {
#if defined(__SSE2__)
  return (V2)_mm_sqrt_pd((__m128d)v);
#elif defined(__wasm_simd128__)
  return (V2)wasm_f64x2_sqrt((v128_t)v);
#else
  return V2{__builtin_sqrt(v[0]), __builtin_sqrt(v[1])};
#endif
}
#if defined(__AVX__)
inline __attribute__((always_inline)) V4 square_root(V4 v) { return (V4)_mm256_sqrt_pd((__m256d)v); }
#endif
#if defined(__AVX512F__)
inline __attribute__((always_inline)) V8 square_root(V8 v) { return (V8)_mm512_sqrt_pd((__m512d)v); }
#endif

template <>
struct Lanes<2> {
  using V = V2;
  struct Quad {
    V2 low, high;
  };
  static inline __attribute__((always_inline)) Quad add(Quad a, Quad b) { return {a.low + b.low, a.high + b.high}; }
  static inline __attribute__((always_inline)) Quad mul(Quad a, Quad b) { return {a.low * b.low, a.high * b.high}; }
  static inline __attribute__((always_inline)) Quad sub(Quad a, Quad b) { return {a.low - b.low, a.high - b.high}; }
  static inline __attribute__((always_inline)) Quad broadcast(double s) { return {V2{s, s}, V2{s, s}}; }
  static inline __attribute__((always_inline)) Quad seen_from_i(Quad a) {
    return {-a.low, __builtin_shufflevector(a.high, a.high, 1, 0)};
  }
  template <class At>
  static inline __attribute__((always_inline)) V collected(const At& at) {
    return V2{at(0), at(1)};
  }
  static inline __attribute__((always_inline)) void transpose_pairs(const V2* rows, V* columns) {
    columns[0] = __builtin_shufflevector(rows[0], rows[1], 0, 2);
    columns[1] = __builtin_shufflevector(rows[0], rows[1], 1, 3);
  }
  static inline __attribute__((always_inline)) void transpose(const Quad* rows, V* columns) {
    columns[0] = __builtin_shufflevector(rows[0].low, rows[1].low, 0, 2);
    columns[1] = __builtin_shufflevector(rows[0].low, rows[1].low, 1, 3);
    columns[2] = __builtin_shufflevector(rows[0].high, rows[1].high, 0, 2);
    columns[3] = __builtin_shufflevector(rows[0].high, rows[1].high, 1, 3);
  }
  static inline __attribute__((always_inline)) void untranspose(const V* columns, Quad* rows) {
    rows[0] = {__builtin_shufflevector(columns[0], columns[1], 0, 2),
               __builtin_shufflevector(columns[2], columns[3], 0, 2)};
    rows[1] = {__builtin_shufflevector(columns[0], columns[1], 1, 3),
               __builtin_shufflevector(columns[2], columns[3], 1, 3)};
  }
};

/// Its Quads are those of two lanes, with what is done to them.
template <>
struct Lanes<1> : Lanes<2> {
  using V = double;
  template <class At>
  static inline __attribute__((always_inline)) V collected(const At& at) {
    return at(0);
  }
  static inline __attribute__((always_inline)) void transpose_pairs(const V2* rows, V* columns) {
    for (int c = 0; c < 2; ++c) columns[c] = rows[0][c];
  }
  static inline __attribute__((always_inline)) void transpose(const Quad* rows, V* columns) {
    transpose_pairs(&rows[0].low, columns);
    transpose_pairs(&rows[0].high, columns + 2);
  }
  static inline __attribute__((always_inline)) void untranspose(const V* columns, Quad* rows) {
    rows[0] = {V2{columns[0], columns[1]}, V2{columns[2], columns[3]}};
  }
};

#if defined(__AVX__)
inline __attribute__((always_inline)) void transpose_four(const V4* rows, V4* columns) {
  const V4 a = __builtin_shufflevector(rows[0], rows[1], 0, 4, 2, 6);
  const V4 b = __builtin_shufflevector(rows[0], rows[1], 1, 5, 3, 7);
  const V4 c = __builtin_shufflevector(rows[2], rows[3], 0, 4, 2, 6);
  const V4 d = __builtin_shufflevector(rows[2], rows[3], 1, 5, 3, 7);
  columns[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5);
  columns[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
  columns[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
  columns[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}

inline __attribute__((always_inline)) void transpose_four_pairs(const V2* rows, V4* columns) {
  const V4 a = __builtin_shufflevector(rows[0], rows[2], 0, 1, 2, 3);
  const V4 b = __builtin_shufflevector(rows[1], rows[3], 0, 1, 2, 3);
  columns[0] = __builtin_shufflevector(a, b, 0, 4, 2, 6);
  columns[1] = __builtin_shufflevector(a, b, 1, 5, 3, 7);
}

template <>
struct Lanes<4> {
  using V = V4;
  using Quad = V4;
  static inline __attribute__((always_inline)) Quad add(Quad a, Quad b) { return a + b; }
  static inline __attribute__((always_inline)) Quad mul(Quad a, Quad b) { return a * b; }
  static inline __attribute__((always_inline)) Quad sub(Quad a, Quad b) { return a - b; }
  static inline __attribute__((always_inline)) Quad broadcast(double s) { return V4{s, s, s, s}; }
  using Bits = std::int64_t __attribute__((vector_size(32)));
  static inline __attribute__((always_inline)) Quad seen_from_i(Quad a) {
    const V4 turned = __builtin_shufflevector(a, a, 0, 1, 3, 2);
    return (V4)((Bits)turned ^ Bits{INT64_MIN, INT64_MIN, 0, 0});
  }
  template <class At>
  static inline __attribute__((always_inline)) V collected(const At& at) {
    return V4{at(0), at(1), at(2), at(3)};
  }
  static inline __attribute__((always_inline)) void transpose_pairs(const V2* rows, V* columns) {
    transpose_four_pairs(rows, columns);
  }
  static inline __attribute__((always_inline)) void transpose(const Quad* rows, V* columns) {
    transpose_four(rows, columns);
  }
  static inline __attribute__((always_inline)) void untranspose(const V* columns, Quad* rows) {
    transpose_four(columns, rows);
  }
};
#endif

#if defined(__AVX512F__)
/// Its Quads are those of four lanes, with what is done to them.
template <>
struct Lanes<8> : Lanes<4> {
  using V = V8;
  static inline __attribute__((always_inline)) V joined(V4 low, V4 high) {
    return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
  }
  template <class At>
  static inline __attribute__((always_inline)) V collected(const At& at) {
    return joined(V4{at(0), at(1), at(2), at(3)}, V4{at(4), at(5), at(6), at(7)});
  }
  static inline __attribute__((always_inline)) void transpose_pairs(const V2* rows, V* columns) {
    V4 low[2], high[2];
    transpose_four_pairs(rows, low);
    transpose_four_pairs(rows + 4, high);
    for (int c = 0; c < 2; ++c) columns[c] = joined(low[c], high[c]);
  }
  /// Numbers 0, 2, 4, 6 of both, taken in turn; numbers 1, 3, 5, 7.
  static inline __attribute__((always_inline)) V even(V a, V b) {
    return __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14);
  }
  static inline __attribute__((always_inline)) V odd(V a, V b) {
    return __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
  }
  /// Rows are joined two by two, so that shuffles of eight do the rest: 12 instead of 20.
  static inline __attribute__((always_inline)) void transpose(const Quad* rows, V* columns) {
    const V a = joined(rows[0], rows[2]), b = joined(rows[1], rows[3]);
    const V c = joined(rows[4], rows[6]), d = joined(rows[5], rows[7]);
    const V low[2] = {even(a, b), odd(a, b)}, high[2] = {even(c, d), odd(c, d)};
    for (int k = 0; k < 2; ++k) {
      columns[k] = __builtin_shufflevector(low[k], high[k], 0, 1, 4, 5, 8, 9, 12, 13);
      columns[k + 2] = __builtin_shufflevector(low[k], high[k], 2, 3, 6, 7, 10, 11, 14, 15);
    }
  }
  static inline __attribute__((always_inline)) void untranspose(const V* columns, Quad* rows) {
    const V left[2] = {even(columns[0], columns[1]), odd(columns[0], columns[1])};
    const V right[2] = {even(columns[2], columns[3]), odd(columns[2], columns[3])};
    for (int k = 0; k < 2; ++k) {
      const V low = __builtin_shufflevector(left[k], right[k], 0, 1, 8, 9, 2, 3, 10, 11);
      const V high = __builtin_shufflevector(left[k], right[k], 4, 5, 12, 13, 6, 7, 14, 15);
      rows[k] = __builtin_shufflevector(low, low, 0, 1, 2, 3);
      rows[k + 2] = __builtin_shufflevector(low, low, 4, 5, 6, 7);
      rows[k + 4] = __builtin_shufflevector(high, high, 0, 1, 2, 3);
      rows[k + 6] = __builtin_shufflevector(high, high, 4, 5, 6, 7);
    }
  }
};
#endif

/// Four doubles of each of W rows, as columns; `row_at(k)` is where the four of row k start.
template <int W>
struct ColumnsOf {
  template <class RowAt>
  static inline __attribute__((always_inline)) void load(const RowAt& row_at, typename Lanes<W>::V* columns) {
    typename Lanes<W>::Quad rows[W];
    for (int k = 0; k < W; ++k) rows[k] = load_as<typename Lanes<W>::Quad>(row_at(k));
    Lanes<W>::transpose(rows, columns);
  }
};

#if defined(__AVX__)
/// Halves joined while they are loaded: one shuffle a column instead of two.
template <>
struct ColumnsOf<4> {
  template <class RowAt>
  static inline __attribute__((always_inline)) void load(const RowAt& row_at, V4* columns) {
    V4 halves[2][2];
    for (int k = 0; k < 2; ++k)
      for (int half = 0; half < 2; ++half)
        halves[half][k] = __builtin_shufflevector(load_as<V2>(row_at(k) + 2 * half),
                                                  load_as<V2>(row_at(k + 2) + 2 * half), 0, 1, 2, 3);
    for (int half = 0; half < 2; ++half) {
      columns[2 * half] = __builtin_shufflevector(halves[half][0], halves[half][1], 0, 4, 2, 6);
      columns[2 * half + 1] = __builtin_shufflevector(halves[half][0], halves[half][1], 1, 5, 3, 7);
    }
  }
};
#endif

/// Rows that follow each other, `stride` doubles apart; and columns back to such rows.
template <int W>
inline __attribute__((always_inline)) void columns_of(const double* rows, long stride, typename Lanes<W>::V* columns) {
  ColumnsOf<W>::load([=](int k) { return rows + k * stride; }, columns);
}
template <int W>
inline __attribute__((always_inline)) void rows_of(const typename Lanes<W>::V* columns, double* row, long stride) {
  typename Lanes<W>::Quad rows[W];
  Lanes<W>::untranspose(columns, rows);
  for (int k = 0; k < W; ++k) store_as(row + k * stride, rows[k]);
}

}  // namespace
}  // namespace rvelab
