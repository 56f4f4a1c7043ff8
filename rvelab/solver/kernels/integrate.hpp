// What the grain loops share. They gather the force rows of each grain's pairs in the order of the pairs, damp,
// integrate, move.
//
//   v' <- P (v' - mean) + R dt (f - damping)/m      P, R from D + 2 Omega at dt > 0, the identity at dt = 0
//   w' <- w' + dt T/I (+ frame terms at dt > 0)
//   x  <- A x + dt B v'                             A, B upper triangular, A = L1 L0^-1 exactly
// (solver/README.md). Sums over grains go into eight interleaved partial sums whatever the number of lanes, so that
// every instruction set adds in the same order.
#pragma once

#include "rvelab/contact/damping.hpp"
#include "rvelab/solver/kernels/pairs.hpp"

namespace rvelab {
namespace {

template <int W_, bool AtRate_, KernelDamping damping_>
struct GrainTraits {
  static constexpr int W = W_;
  static constexpr bool AtRate = AtRate_;
  static constexpr KernelDamping damping = damping_;
};

/// Eight partial sums, filled W at a time; total() adds them in a fixed order. Loops over grains go by eights, so that
/// the part is known when compiled and the sums stay in registers.
template <int W>
struct PartialSums {
  using V = typename Lanes<W>::V;
  V part[8 / W] = {};
  inline __attribute__((always_inline)) void add(int which, V value) { part[which] = part[which] + value; }
  inline __attribute__((always_inline)) double total() const {
    double values[8];
    for (int k = 0; k < 8 / W; ++k) store_as(values + k * W, part[k]);
    return ((values[0] + values[4]) + (values[2] + values[6])) + ((values[1] + values[5]) + (values[3] + values[7]));
  }
};

/// Largest of the lanes; the order cannot matter.
template <class V>
inline __attribute__((always_inline)) double largest_of(V v) {
  double values[sizeof(V) / sizeof(double)];
  store_as(values, v);
  double largest = values[0];
  for (double value : values) largest = value > largest ? value : largest;
  return largest;
}

/// Sums of a call (StepSums). Momentum by components, not as an array: the sums stay in registers so (grain loop of
/// discs, AVX2: 705 instructions of code instead of 767).
template <int W>
struct LaneSums {
  PartialSums<W> momentum_x, momentum_y, momentum_z, lost_locally, lost_globally;
  typename Lanes<W>::V fastest = {};

  template <int D>
  inline __attribute__((always_inline)) void add_momentum(int part, typename Lanes<W>::V mass,
                                                          const Vec<typename Lanes<W>::V, D>& v) {
    momentum_x.add(part, mass * v.x);
    momentum_y.add(part, mass * v.y);
    if constexpr (D == 3) momentum_z.add(part, mass * v.z);
  }
  inline __attribute__((always_inline)) void see_speed(typename Lanes<W>::V speed) {
    fastest = (speed > fastest) ? speed : fastest;
  }
  inline __attribute__((always_inline)) void put(StepSums* sums) const {
    sums->momentum[0] = momentum_x.total();
    sums->momentum[1] = momentum_y.total();
    sums->momentum[2] = momentum_z.total();
    sums->largest_speed_squared = largest_of(fastest);
    sums->local_damping = lost_locally.total();
    sums->global_damping = lost_globally.total();
  }
};

/// A row of four doubles for every task of a chunk (GrainArrays): grains as j, then grains as i.
struct alignas(64) TaskRows {
  double at[8 * chunk_grains];
  inline __attribute__((always_inline)) double* of(std::uint16_t task) { return at + task; }
  inline __attribute__((always_inline)) const double* as_j(long k) const { return at + 4 * k; }
  inline __attribute__((always_inline)) const double* as_i(long k) const { return at + 4 * (chunk_grains + k); }
};
inline bool is_as_j(std::uint16_t task) { return task < 4 * chunk_grains; }

/// Sums of the force rows of a chunk; what they hold differs by dimension and shape (`Sum`).
struct ChunkSums {
  TaskRows forces;   ///< in the plane with the torque
  TaskRows torques;  ///< in space
};

/// The force rows of a chunk of grains, by tasks, over the pairs in which they are j and over those in which they are
/// i. `Sum`: what one task adds up, begin(), add() and put().
template <class Sum>
inline __attribute__((always_inline)) void gather_forces(const GrainArrays& grains, const PairArrays& pairs, long first,
                                                         long count, ChunkSums& sums) {
  // Copies that no store can change (kernels/pairs.hpp).
  const GrainArrays g = grains;
  const PairArrays p = pairs;
  const std::int32_t* slot = g.slots + 4L * g.slot_begin[first / 2];
  for (long block = first / 2; block < (first + count) / 2; ++block) {
    const std::int32_t* last = g.slots + 4L * g.slot_begin[block + 1];
    const std::uint16_t* tasks = g.tasks + 4 * block;
    Sum sum[4];
#pragma GCC unroll 4
    for (int k = 0; k < 4; ++k) sum[k].begin(p, tasks[k]);
    for (; slot != last; slot += 4)
#pragma GCC unroll 4
      for (int k = 0; k < 4; ++k) sum[k].add(p, slot[k]);
#pragma GCC unroll 4
    for (int k = 0; k < 4; ++k) sum[k].put(g, first, tasks[k], sums);
  }
}

/// Four doubles, of which zeros are left.
template <int W>
inline __attribute__((always_inline)) typename Lanes<W>::Quad taken(double* from) {
  const auto value = quad_at<W>(from);
  store_as(from, Lanes<W>::broadcast(0.0));
  return value;
}

/// Global damping, which acts on v' at a rate; what it takes goes to `lost`.
template <int W, class V, int D>
inline __attribute__((always_inline)) void damp_globally(const StepConstants& c, const Vec<V, D>& v, Vec<V, D>& force,
                                                         int part, PartialSums<W>& lost) {
  if (c.global_viscous == 0.0) return;
  force = minus(force, c.global_viscous, v);
  if (c.losses) lost.add(part, c.dt * c.global_viscous * dot(v, v));
}

/// Local damping by components of force or torque, `ahead` the velocity or spin half a step ahead; in the plane a
/// torque has one.
template <class V>
inline __attribute__((always_inline)) V damped_by_component(const StepConstants& c, V force, V ahead) {
  return damped_component(c.local_damping, force, ahead);
}
template <class V, int D>
inline __attribute__((always_inline)) Vec<V, D> damped_by_component(const StepConstants& c, const Vec<V, D>& force,
                                                                    const Vec<V, D>& ahead) {
  if constexpr (D == 2)
    return {damped_component(c.local_damping, force.x, ahead.x), damped_component(c.local_damping, force.y, ahead.y)};
  else
    return {damped_component(c.local_damping, force.x, ahead.x), damped_component(c.local_damping, force.y, ahead.y),
            damped_component(c.local_damping, force.z, ahead.z)};
}
/// Its factor in the form that does not depend on the axes.
template <class V, int D>
inline __attribute__((always_inline)) V damping_factor(const StepConstants& c, const Vec<V, D>& force,
                                                       const Vec<V, D>& ahead) {
  return local_damping_factor(c.local_damping, dot(force, force), dot(ahead, ahead));
}
/// What local damping takes, to `lost`.
template <int W, class V, int D, class Torque>
inline __attribute__((always_inline)) void book_local_damping(const StepConstants& c, const Vec<V, D>& force_taken,
                                                              const Vec<V, D>& ahead, const Torque& torque_taken,
                                                              const Torque& spin_ahead, int part,
                                                              PartialSums<W>& lost) {
  if (c.losses) lost.add(part, c.dt * (dot(force_taken, ahead) + dot(torque_taken, spin_ahead)));
}

/// The loop over grains, a chunk at a time in passes, as the pair loops. `Step`: the passes of plane or space.
template <class Step>
void grain_loop(const StepConstants& constants, const GrainArrays& grains, const PairArrays& pairs, long begin,
                long end, StepSums* sums) {
  const StepConstants c = constants;  // copies that no store can change (pairs.hpp)
  const GrainArrays g = grains;
  LaneSums<Step::W> lane_sums;
  typename Step::Columns columns;
  ChunkSums chunk_sums;
  for (long chunk = begin; chunk < end; chunk += chunk_grains) {
    const long count = end - chunk < chunk_grains ? end - chunk : chunk_grains;
    if (g.before_chunk != nullptr) g.before_chunk(g.sweep, chunk + count);
    Step::gather(grains, pairs, chunk, count, chunk_sums);
    if (g.resultants == nullptr)
      Step::template damp<false>(c, g, chunk, count, chunk_sums, columns, lane_sums);
    else
      Step::template damp<true>(c, g, chunk, count, chunk_sums, columns, lane_sums);
    Step::move(c, g, chunk, count, columns, lane_sums);
  }
  lane_sums.put(sums);
}

}  // namespace
}  // namespace rvelab
