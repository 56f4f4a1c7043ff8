// The grain loop in the plane (integrate.hpp).
#pragma once

#include "rvelab/solver/kernels/integrate.hpp"

namespace rvelab {
namespace {

/// What the passes over a chunk of grains hand on.
struct PlaneColumns {
  VecColumn<2> force;  ///< resultants
  ScratchColumn torque;
  VecColumn<2> position, velocity;
  VecColumn<2> ahead;    ///< velocity half a step ahead
  ScratchColumn factor;  ///< how much of it local damping takes off the force
};

/// Sum of force rows {fx, fy, T_j, T_i}, for gather_forces.
template <int W>
struct PlaneRowSum {
  using L = Lanes<W>;
  typename L::Quad sum;
  inline __attribute__((always_inline)) void begin(const PairArrays&, std::uint16_t) { sum = L::broadcast(0.0); }
  inline __attribute__((always_inline)) void add(const PairArrays& p, std::int32_t slot) {
    sum = L::add(sum, quad_at<W>(p.force + slot));
  }
  inline __attribute__((always_inline)) void put(const GrainArrays&, long, std::uint16_t task, ChunkSums& to) {
    store_as(to.forces.of(task), sum);
  }
};
template <int W>
inline __attribute__((always_inline)) void gather_in_plane(const GrainArrays& g, const PairArrays& p, long first,
                                                           long count, ChunkSums& sums) {
  gather_forces<PlaneRowSum<(W < 4 ? W : 4)>>(g, p, first, count, sums);
}
/// {fx, fy, T, -} of grain k of a chunk: the sum as j, less forces and plus T_i of the sum as i.
template <int W>
inline __attribute__((always_inline)) typename Lanes<W>::Quad resultant_in_plane(const ChunkSums& sums, long k) {
  using L = Lanes<W>;
  return L::add(quad_at<W>(sums.forces.as_j(k)), L::seen_from_i(quad_at<W>(sums.forces.as_i(k))));
}

/// What the grain loop in the plane asks of a shape: the length of its rows, and what turns with the grain.
struct DiscRows {
  static constexpr int length = Disc::row_length;
  static constexpr bool turns = false;
};

/// The passes of grain_loop, `Rows` as DiscRows.
template <class Rows, class T>
struct PlaneGrains {
  static constexpr int W = T::W, length = Rows::length;
  using L = Lanes<W>;
  using V = typename L::V;
  using Columns = PlaneColumns;

  static inline __attribute__((always_inline)) void gather(const GrainArrays& g, const PairArrays& p, long first,
                                                           long count, ChunkSums& sums) {
    gather_in_plane<W>(g, p, first, count, sums);
  }

  /// Resultants of a chunk. Then global damping and the factor of the local one. Two passes, the first of which ends
  /// with the root, as in the pair loops (time of the grain loop, AVX2: 1 with rows and damping in passes of their own,
  /// 0.93 so).
  template <bool interactions>
  static inline __attribute__((always_inline)) void damp(const StepConstants& c, const GrainArrays& g, long first,
                                                         long count, const ChunkSums& sums, PlaneColumns& s,
                                                         LaneSums<W>& lane_sums) {
    const double half_dt = 0.5 * c.dt;
    for (long eight = 0; eight < count; eight += 8)
#pragma GCC unroll 2
      for (int part = 0; part < 8 / W; ++part) {
        const long k = eight + part * W, at = first + k;
        typename L::Quad net[W];
        for (int lane = 0; lane < W; ++lane) net[lane] = resultant_in_plane<W>(sums, k + lane);
        if constexpr (interactions)
          for (int lane = 0; lane < W; ++lane)
            net[lane] = L::add(net[lane], taken<W>(g.resultants + length * (at + lane)));
        V resultant[4], a[4];
        L::transpose(net, resultant);
        Vec<V, 2> f = first_of<2>(resultant);
        store_as(s.torque.at + k, resultant[2]);
        columns_of<W>(g.rows + length * at, length, a);
        s.position.store(k, first_of<2>(a));
        const Vec<V, 2> v = {a[2] - c.mean_velocity[0], a[3] - c.mean_velocity[1]};
        s.velocity.store(k, v);
        if constexpr (T::AtRate) damp_globally(c, v, f, part, lane_sums.lost_globally);
        s.force.store(k, f);
        if constexpr (T::damping != KernelDamping::none) {
          const Vec<V, 2> ahead = plus(v, half_dt, times(load_as<V>(g.inverse_mass + at), f));
          s.ahead.store(k, ahead);
          if constexpr (T::damping == KernelDamping::vector) store_as(s.factor.at + k, damping_factor(c, f, ahead));
        }
      }
  }

  /// Local damping; velocities and positions after the step, to the rows.
  static inline __attribute__((always_inline)) void move(const StepConstants& c, const GrainArrays& g, long first,
                                                         long count, PlaneColumns& s, LaneSums<W>& sums) {
    const double half_dt = 0.5 * c.dt;
    for (long eight = 0; eight < count; eight += 8)
#pragma GCC unroll 2
      for (int part = 0; part < 8 / W; ++part) {
        const long k = eight + part * W, at = first + k;
        const V inverse_mass = load_as<V>(g.inverse_mass + at), inverse_inertia = load_as<V>(g.inverse_inertia + at);
        Vec<V, 2> f = s.force.load<V>(k), v = s.velocity.load<V>(k);
        V torque = load_as<V>(s.torque.at + k);
        double* row = g.rows + length * at;
        [[maybe_unused]] V spin_and_axis[4];
        V w;
        if constexpr (Rows::turns) {
          columns_of<W>(row + 4, length, spin_and_axis);
          w = spin_and_axis[0];
        } else {
          w = Lanes<W>::collected([=](int lane) { return row[length * lane + 4]; });
        }
        if constexpr (T::damping != KernelDamping::none) {
          const Vec<V, 2> free = f, ahead = s.ahead.load<V>(k);
          const V free_torque = torque, spin_ahead = w + half_dt * (torque * inverse_inertia);
          if constexpr (T::damping == KernelDamping::vector)
            f = minus(f, load_as<V>(s.factor.at + k), ahead);
          else
            f = damped_by_component(c, f, ahead);
          torque = damped_by_component(c, torque, spin_ahead);
          if constexpr (T::AtRate)
            book_local_damping(c, free - f, ahead, free_torque - torque, spin_ahead, part, sums.lost_locally);
        }
        v = next_velocity<T::AtRate>(c, v, times(c.dt, times(inverse_mass, f)));
        if constexpr (T::AtRate) w = w + c.spin_shift[2];
        w = w + c.dt * (torque * inverse_inertia);
        sums.add_momentum(part, load_as<V>(g.mass + at), v);
        if constexpr (!Rows::turns) sums.see_speed(dot(v, v));
        const Vec<V, 2> x = next_position(c, s.position.load<V>(k), v);
        const V to[4] = {x.x, x.y, v.x, v.y};
        rows_of<W>(to, row, length);
        if constexpr (Rows::turns) {
          Rows::template turn<W>(c, g, at, v, w, spin_and_axis, sums);
        } else {
          double spins[W];
          std::memcpy(spins, &w, sizeof(V));
#pragma GCC unroll 8
          for (int lane = 0; lane < W; ++lane) row[length * lane + 4] = spins[lane];
        }
      }
  }
};

}  // namespace
}  // namespace rvelab
