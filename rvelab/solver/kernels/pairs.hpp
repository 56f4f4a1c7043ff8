// What the pair loops share: traits, loading grain rows by columns, the columns that passes hand on.
//
// A pair loop goes from grain rows to force rows, W listed pairs at a time, a chunk of pairs in passes: the rows of the
// two grains to columns, place and motion, the contact law. The passes hand columns on through a scratch buffer. In one
// pass every block of lanes is a chain of roots and divisions longer than a processor looks ahead; split, the next
// block starts while this one waits (Cascade Lake, AVX2, ns a pair: discs 8.0 in one pass, 7.1 in two;
// spheres 27.6, 21.2). So a pass ends with its roots, and the shuffles that feed a root stand beside it.
//
// n from i to j, overlap delta = ri + rj - |b|, forces are those on j. Velocities: the relative velocity of the
// centres over the step is dv' + D+ (b - dt/2 dv'), exactly (b_new - b_old)/dt. Slip (contact/README.md):
//   consistent              s v_t - a_j w_j - a_i w_i,  a = r - delta/2, s = 1
//   full_radius             a = r, s = 1 (LAMMPS; twist of the history is left out as there)
//   full_radius_ratcheting  a = r, s = (ri + rj)/|b| (YADE)
// Torques act at r - delta/2 for all of them. In 2D the tangent is t = (-n_y, n_x) and all moments lie along z.
#pragma once

#include "rvelab/solver/kernels/motion.hpp"

namespace rvelab {
namespace {

/// What a pair loop is compiled for beside its law. `Foreign`: with the slip of another code; StepConstants::slip says
/// which. These serve comparison: a branch in their loops saves a kernel for each.
template <int W_, bool Rolling_, bool Foreign_, bool Dashpot_, bool Advance_,
          HertzRadius hertz_radius_ = HertzRadius::equivalent>
struct PairTraits {
  static constexpr int W = W_;
  static constexpr bool Rolling = Rolling_, Dashpot = Dashpot_, Advance = Advance_;
  static constexpr bool Ledger = W == 1 && Advance;  ///< adds up what contacts lose, where a Dissipation is handed in
  static constexpr bool Foreign = Foreign_;
  static constexpr bool Moves = Advance || Dashpot;  ///< uses relative velocities
  static constexpr bool Curvature = hertz_radius_ == HertzRadius::curvature;
};

/// Loads one Quad of each of W grain rows and turns them into columns; `sign` multiplies the first set before adding.
template <int W>
inline __attribute__((always_inline)) void gather_columns(const double* rows, const std::int32_t* first,
                                                          const std::int32_t* second, int offset,
                                                          typename Lanes<W>::Quad sign, typename Lanes<W>::V* columns) {
  using L = Lanes<W>;
  typename L::Quad quads[W];
  for (int k = 0; k < W; ++k) {
    const auto a = load_as<typename L::Quad>(rows + first[k] + offset);
    const auto b = load_as<typename L::Quad>(rows + second[k] + offset);
    quads[k] = L::add(b, L::mul(sign, a));
  }
  L::transpose(quads, columns);
}

template <int W>
inline __attribute__((always_inline)) typename Lanes<W>::Quad quad(double a, double b, double c, double d) {
  const double values[4] = {a, b, c, d};
  return load_as<typename Lanes<W>::Quad>(values);
}

template <int W>
inline __attribute__((always_inline)) typename Lanes<W>::Quad quad_at(const double* from) {
  return load_as<typename Lanes<W>::Quad>(from);
}

/// The first D of four doubles of the grain row of j minus those of i, and what follows them there.
template <int W, int D>
inline __attribute__((always_inline)) Vec<typename Lanes<W>::V, D> gather_differences(
    const double* rows, const std::int32_t* i, const std::int32_t* j, typename Lanes<W>::V* following = nullptr) {
  using L = Lanes<W>;
  typename L::Quad quads[W];
  typename L::V columns[4];
  for (int k = 0; k < W; ++k) quads[k] = L::sub(quad_at<W>(rows + j[k]), quad_at<W>(rows + i[k]));
  L::transpose(quads, columns);
  if (following != nullptr)
    for (int k = D; k < 4; ++k) following[k - D] = columns[k];
  return first_of<D>(columns);
}

/// Positions in the plane of j less those of i, without what follows them.
template <int W>
inline __attribute__((always_inline)) Vec<typename Lanes<W>::V, 2> gather_position_differences(const double* rows,
                                                                                               const std::int32_t* i,
                                                                                               const std::int32_t* j) {
  V2 differences[W];
  typename Lanes<W>::V columns[2];
  for (int k = 0; k < W; ++k) differences[k] = load_as<V2>(rows + j[k]) - load_as<V2>(rows + i[k]);
  Lanes<W>::transpose_pairs(differences, columns);
  return {columns[0], columns[1]};
}

/// Spins of discs, as a column.
template <int W>
inline __attribute__((always_inline)) typename Lanes<W>::V gather_spins(const double* rows, const std::int32_t* grain) {
  return Lanes<W>::collected([=](int lane) { return rows[grain[lane] + 4]; });
}

/// Compiler barrier: what was loaded before is loaded again.
inline __attribute__((always_inline)) void read_memory_again() { asm volatile("" ::: "memory"); }

/// Pairs of one chunk: the scratch of all passes stays in the first-level cache.
constexpr long chunk_pairs = 64;

/// Pairs that follow each other and are computed together, and where to look for the next ones.
struct PairRun {
  long first, count, next;
};

/// The next chunk of pairs from `at` on: as many of those near each other as there are; beyond them, eight at a time,
/// those of which one touches, by `touches(first)`, or did at the last step, so that its force has to go. A pair for
/// which this is false holds neither force nor history, and its overlap would come out at 0 or less: with |b|^2 not
/// below (ri + rj)^2, as rounded, the correctly rounded root of |b|^2 is not below ri + rj.
/// Spheres with 2.4 contacts and 3.6 listed pairs a grain: 469 instructions a grain-step instead of 556 (AVX2), 1.16
/// times the grain-steps a second. Not to look at blocks of eight that cannot have closed their gaps since the last
/// look was no gain (speed over that of this: spheres 1.01, discs 0.97).
template <class Touches>
inline __attribute__((always_inline)) PairRun next_run(const PairArrays& p, long at, long end, const Touches& touches) {
  if (at < p.near) {
    const long to = p.near < end ? p.near : end;
    const long count = to - at < chunk_pairs ? to - at : chunk_pairs;
    return {at, count, at + count};
  }
  long first = at, count = 0;
  while (at < end && count < chunk_pairs) {
    const bool now = touches(at), active = now | bool(p.touched[at / 8]);
    p.touched[at / 8] = now;
    if (active) {
      if (count == 0) first = at;
      count += 8;
    }
    at += 8;
    if (!active && count > 0) break;
  }
  return {first, count, at};
}

/// One quantity of every pair, or grain, of a chunk.
struct alignas(64) ScratchColumn {
  double at[chunk_pairs];
};

/// A vector quantity of every pair, or grain, of a chunk.
template <int D>
struct VecColumn {
  ScratchColumn along[D];

  template <class V>
  inline __attribute__((always_inline)) void store(long at, const Vec<V, D>& value) {
    store_as(along[0].at + at, value.x);
    store_as(along[1].at + at, value.y);
    if constexpr (D == 3) store_as(along[2].at + at, value.z);
  }
  template <class V>
  inline __attribute__((always_inline)) Vec<V, D> load(long at) const {
    if constexpr (D == 2)
      return {load_as<V>(along[0].at + at), load_as<V>(along[1].at + at)};
    else
      return {load_as<V>(along[0].at + at), load_as<V>(along[1].at + at), load_as<V>(along[2].at + at)};
  }
};
using TripleColumn = VecColumn<3>;

/// The loop over pairs of a shape, a run at a time: located, then updated by `Update` (plane.hpp, space.hpp).
template <class Shape, class T, class Update>
void pair_loop(const StepConstants& constants, const PairArrays& arrays, const double* rows, long begin, long end,
               Dissipation* dissipation) {
  // Copies that no store can change: else every store would make the compiler read all pointers again.
  const StepConstants c = constants;
  const PairArrays p = arrays;
  typename Shape::Scratch scratch;
  constexpr int narrow = T::W < 4 ? T::W : 4;
  for (PairRun run{begin, 0, begin}; run.next < end;) {
    run = next_run(p, run.next, end, [&](long at) { return Shape::template may_touch<narrow>(c, p, rows, at); });
    Shape::template locate<T>(c, p, rows, run.first, run.count, scratch);
    Update::run(c, p, rows, run.first, run.count, scratch, dissipation);
  }
}

/// The normal force, no smaller than where the surfaces press no more.
template <class Law, class V>
inline __attribute__((always_inline)) V without_tension(V normal, V law_constant) {
  const V pressing = Law::pressing_force(normal, law_constant);
  return (pressing > 0.0) ? normal : normal - pressing;
}

}  // namespace
}  // namespace rvelab
