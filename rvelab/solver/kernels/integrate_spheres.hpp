// The grain loop in space (integrate.hpp).
#pragma once

#include "rvelab/solver/kernels/integrate.hpp"

namespace rvelab {
namespace {

/// What the passes over a chunk of spheres hand on.
struct SphereColumns {
  TripleColumn force, torque;  ///< resultants
  TripleColumn velocity, spin;
  TripleColumn ahead, spin_ahead;  ///< velocity and spin half a step ahead
  ScratchColumn along, about;      ///< how much of them local damping takes off force and torque
};

/// Sum of rows of eight, in halves. With eight lanes a row is one vector (1,000 spheres: 0.977 of the time).
template <int W>
struct RowSum {
  using L = Lanes<W>;
  using Quad = typename L::Quad;
  Quad first = L::broadcast(0.0), second = L::broadcast(0.0);
  inline __attribute__((always_inline)) void add(const double* row) {
    first = L::add(first, quad_at<W>(row));
    second = L::add(second, quad_at<W>(row + 4));
  }
  inline __attribute__((always_inline)) Quad first_half() const { return first; }
  inline __attribute__((always_inline)) Quad second_half() const { return second; }
};
#if defined(__AVX512F__)
template <>
struct RowSum<8> {
  V8 sum = {};
  inline __attribute__((always_inline)) void add(const double* row) { sum = sum + load_as<V8>(row); }
  inline __attribute__((always_inline)) V4 first_half() const { return __builtin_shufflevector(sum, sum, 0, 1, 2, 3); }
  inline __attribute__((always_inline)) V4 second_half() const { return __builtin_shufflevector(sum, sum, 4, 5, 6, 7); }
};
#endif

/// Sum of the moments of rolling, which are minus on i, plus on j.
template <int W, bool Rolling>
struct MomentSum {
  double sum[4] = {};
  inline __attribute__((always_inline)) void add(const PairArrays& p, std::int32_t slot) {
    if constexpr (Rolling)
      for (int m = 0; m < 3; ++m) sum[m] += p.moment[m][slot / force_row_length(3)];
  }
  using L = Lanes<W>;
  inline __attribute__((always_inline)) typename L::Quad added_to(typename L::Quad torque, std::uint16_t task) const {
    if constexpr (!Rolling) return torque;
    return L::add(torque, L::mul(L::broadcast(is_as_j(task) ? 1.0 : -1.0), quad_at<W>(sum)));
  }
};

/// Of the force rows of spheres, for gather_forces: force and torque. Torque on either grain of a pair: -(r - delta/2)
/// n x f_t.
template <int W, bool Rolling>
struct SphereRowSum {
  static constexpr int narrow = W < 4 ? W : 4;
  using L = Lanes<narrow>;
  RowSum<W> sum;
  typename L::Quad arm = L::broadcast(0.0);
  MomentSum<narrow, Rolling> moment;
  inline __attribute__((always_inline)) void begin(const PairArrays&, std::uint16_t) {}
  inline __attribute__((always_inline)) void add(const PairArrays& p, std::int32_t slot) {
    const double* row = p.force + slot;
    sum.add(row);
    arm = L::add(arm, L::mul(L::broadcast(row[3]), quad_at<narrow>(row + 4)));
    moment.add(p, slot);
  }
  inline __attribute__((always_inline)) void put(const GrainArrays& g, long first, std::uint16_t task, ChunkSums& to) {
    const double radius = g.rows[12 * first + 3 * (task % (4 * chunk_grains)) + 3];
    const auto torque = L::sub(arm, L::mul(L::broadcast(radius), sum.second_half()));
    store_as(to.forces.of(task), sum.first_half());
    store_as(to.torques.of(task), moment.added_to(torque, task));
  }
};
template <int W>
inline __attribute__((always_inline)) void gather_spheres(const GrainArrays& g, const PairArrays& p, long first,
                                                          long count, ChunkSums& sums) {
  if (g.rolling)
    gather_forces<SphereRowSum<W, true>>(g, p, first, count, sums);
  else
    gather_forces<SphereRowSum<W, false>>(g, p, first, count, sums);
}
/// {f, -} and {T, -} of grain k of a chunk.
template <int W>
inline __attribute__((always_inline)) typename Lanes<W>::Quad force_in_space(const ChunkSums& sums, long k) {
  return Lanes<W>::sub(quad_at<W>(sums.forces.as_j(k)), quad_at<W>(sums.forces.as_i(k)));
}
template <int W>
inline __attribute__((always_inline)) typename Lanes<W>::Quad torque_in_space(const ChunkSums& sums, long k) {
  return Lanes<W>::add(quad_at<W>(sums.torques.as_j(k)), quad_at<W>(sums.torques.as_i(k)));
}

/// The passes of grain_loop.
template <class T>
struct SphereGrains {
  static constexpr int W = T::W;
  using L = Lanes<W>;
  using V = typename L::V;
  using Columns = SphereColumns;

  static inline __attribute__((always_inline)) void gather(const GrainArrays& g, const PairArrays& p, long first,
                                                           long count, ChunkSums& sums) {
    gather_spheres<W>(g, p, first, count, sums);
  }

  /// Resultants of a chunk, global damping and the factors of the local one; as in the plane, this pass ends with the
  /// roots. What interactions give comes here, where a compiler has both (in the gathering pass: 5 instructions a grain
  /// more).
  template <bool interactions>
  static inline __attribute__((always_inline)) void damp(const StepConstants& c, const GrainArrays& g, long first,
                                                         long count, const ChunkSums& sums, SphereColumns& s,
                                                         LaneSums<W>& lane_sums) {
    const V half_dt = V{} + 0.5 * c.dt;
    const Triple<V> mean = {V{} + c.mean_velocity[0], V{} + c.mean_velocity[1], V{} + c.mean_velocity[2]};
    for (long eight = 0; eight < count; eight += 8)
#pragma GCC unroll 2
      for (int part = 0; part < 8 / W; ++part) {
        const long k = eight + part * W, at = first + k;
        typename L::Quad quads[W];
        V a[4];
        for (int lane = 0; lane < W; ++lane) quads[lane] = force_in_space<W>(sums, k + lane);
        if constexpr (interactions)
          for (int lane = 0; lane < W; ++lane)
            quads[lane] = L::add(quads[lane], taken<W>(g.resultants + 12 * (at + lane)));
        L::transpose(quads, a);
        Triple<V> f = first_of<3>(a);
        for (int lane = 0; lane < W; ++lane) quads[lane] = torque_in_space<W>(sums, k + lane);
        if constexpr (interactions)
          for (int lane = 0; lane < W; ++lane)
            quads[lane] = L::add(quads[lane], taken<W>(g.resultants + 12 * (at + lane) + 4));
        L::transpose(quads, a);
        const Triple<V> t = first_of<3>(a);
        const double* row = g.rows + 12 * at;
        const Triple<V> v = triple_of<W>(row + 4, 12) - mean;
        s.velocity.store(k, v);
        const Triple<V> w = triple_of<W>(row + 8, 12);
        s.spin.store(k, w);
        if constexpr (T::AtRate) damp_globally(c, v, f, part, lane_sums.lost_globally);
        s.force.store(k, f);
        s.torque.store(k, t);
        if constexpr (T::damping != KernelDamping::none) {
          const V inverse_mass = load_as<V>(g.inverse_mass + at), inverse_inertia = load_as<V>(g.inverse_inertia + at);
          const Triple<V> ahead = plus(v, half_dt, times(inverse_mass, f));
          const Triple<V> spin_ahead = plus(w, half_dt, times(inverse_inertia, t));
          s.ahead.store(k, ahead);
          s.spin_ahead.store(k, spin_ahead);
          if constexpr (T::damping == KernelDamping::vector) {
            store_as(s.along.at + k, damping_factor(c, f, ahead));
            store_as(s.about.at + k, damping_factor(c, t, spin_ahead));
          }
        }
      }
  }

  /// Local damping; velocities and positions after the step, to the rows.
  static inline __attribute__((always_inline)) void move(const StepConstants& c, const GrainArrays& g, long first,
                                                         long count, SphereColumns& s, LaneSums<W>& sums) {
    const V dt = V{} + c.dt;
    for (long eight = 0; eight < count; eight += 8)
#pragma GCC unroll 2
      for (int part = 0; part < 8 / W; ++part) {
        const long k = eight + part * W, at = first + k;
        Triple<V> f = s.force.load<V>(k), t = s.torque.load<V>(k);
        if constexpr (T::damping != KernelDamping::none) {
          const Triple<V> free = f, free_torque = t;
          const Triple<V> ahead = s.ahead.load<V>(k), spin_ahead = s.spin_ahead.load<V>(k);
          if constexpr (T::damping == KernelDamping::vector) {
            f = minus(f, load_as<V>(s.along.at + k), ahead);
            t = minus(t, load_as<V>(s.about.at + k), spin_ahead);
          } else {
            f = damped_by_component(c, f, ahead);
            t = damped_by_component(c, t, spin_ahead);
          }
          if constexpr (T::AtRate)
            book_local_damping(c, free - f, ahead, free_torque - t, spin_ahead, part, sums.lost_locally);
        }
        const Triple<V> gained = times(dt, times(load_as<V>(g.inverse_mass + at), f));
        const Triple<V> v = next_velocity<T::AtRate>(c, s.velocity.load<V>(k), gained);
        Triple<V> w = s.spin.load<V>(k);
        if constexpr (T::AtRate) {
          w = mapped(c.spin_map, w);
          w = {w.x + c.spin_shift[0], w.y + c.spin_shift[1], w.z + c.spin_shift[2]};
        }
        w = plus(w, dt, times(load_as<V>(g.inverse_inertia + at), t));
        sums.add_momentum(part, load_as<V>(g.mass + at), v);
        sums.see_speed(dot(v, v));
        double* row = g.rows + 12 * at;
        V x[4];
        columns_of<W>(row, 12, x);
        rows_of<W>(next_position(c, first_of<3>(x), v), x[3], row, 12);
        rows_of<W>(v, V{}, row + 4, 12);
        rows_of<W>(w, x[3], row + 8, 12);
      }
  }
};

}  // namespace
}  // namespace rvelab
