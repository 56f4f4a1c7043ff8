// The grain loop of discs (integrate.hpp).
#pragma once

#include "rvelab/contact/damping.hpp"
#include "rvelab/solver/kernels/integrate.hpp"

namespace rvelab {
namespace {

/// What the passes over a chunk of discs hand on.
struct DiscColumns {
  ScratchColumn fx, fy, torque;  ///< resultants
  ScratchColumn x, y, u, v;
  ScratchColumn px, py, factor;  ///< velocity half a step ahead, and how much of it local damping takes off the force
};

/// Sums of the force rows of a chunk of discs, over the pairs in which they are j and over those in which they are i.
template <int W>
inline __attribute__((always_inline)) void gather_disc_forces(const GrainArrays& g, const PairArrays& p, long first,
                                                              long count, TaskRows& sums) {
  using L = Lanes<W>;
  using Quad = typename L::Quad;
  const std::int32_t* slot = g.slots + 4L * g.slot_begin[first / 2];
  for (long block = first / 2; block < (first + count) / 2; ++block) {
    const std::int32_t* last = g.slots + 4L * g.slot_begin[block + 1];
    Quad sum[4];
    for (int k = 0; k < 4; ++k) sum[k] = L::broadcast(0.0);
    for (; slot != last; slot += 4)
#pragma GCC unroll 4
      for (int k = 0; k < 4; ++k) sum[k] = L::add(sum[k], quad_at<W>(p.force + slot[k]));
#pragma GCC unroll 4
    for (int k = 0; k < 4; ++k) store_as(sums.of(g.tasks[4 * block + k]), sum[k]);
  }
}

/// Resultants of a chunk: the sum as j, less forces and plus T_i of the sum as i. Then global damping and the factor of
/// the local one. Two passes, the first of which ends with the root, as in the pair loops (time of the grain loop,
/// AVX2: 1 with rows and damping in passes of their own, 0.93 so).
template <class T, int length, bool interactions>
inline __attribute__((always_inline)) void damp_discs(const StepConstants& c, const GrainArrays& g, long first,
                                                      long count, const TaskRows& sums, DiscColumns& s,
                                                      PartialSums<T::W>& lost_globally) {
  constexpr int W = T::W;
  using L = Lanes<W>;
  using V = typename L::V;
  const double half_dt = 0.5 * c.dt;
  for (long eight = 0; eight < count; eight += 8)
#pragma GCC unroll 2
    for (int part = 0; part < 8 / W; ++part) {
      const long k = eight + part * W, at = first + k;
      typename L::Quad net[W];
      for (int lane = 0; lane < W; ++lane)
        net[lane] = L::add(quad_at<W>(sums.as_j(k + lane)), L::seen_from_i(quad_at<W>(sums.as_i(k + lane))));
      if constexpr (interactions)
        for (int lane = 0; lane < W; ++lane)
          net[lane] = L::add(net[lane], taken<W>(g.resultants + length * (at + lane)));
      V resultant[4], a[4];
      L::transpose(net, resultant);
      V fx = resultant[0], fy = resultant[1];
      store_as(s.torque.at + k, resultant[2]);
      columns_of<W>(g.rows + length * at, length, a);
      store_as(s.x.at + k, a[0]);
      store_as(s.y.at + k, a[1]);
      const V u = a[2] - c.mean_velocity[0], v = a[3] - c.mean_velocity[1];
      store_as(s.u.at + k, u);
      store_as(s.v.at + k, v);
      if constexpr (T::AtRate) {
        if (c.global_viscous != 0.0) {
          fx = fx - c.global_viscous * u;
          fy = fy - c.global_viscous * v;
          if (c.losses) lost_globally.add(part, c.dt * c.global_viscous * (u * u + v * v));
        }
      }
      store_as(s.fx.at + k, fx);
      store_as(s.fy.at + k, fy);
      if constexpr (T::damping != KernelDamping::none) {
        const V inverse_mass = load_as<V>(g.inverse_mass + at);
        const V px = u + half_dt * (fx * inverse_mass), py = v + half_dt * (fy * inverse_mass);
        store_as(s.px.at + k, px);
        store_as(s.py.at + k, py);
        if constexpr (T::damping == KernelDamping::vector)
          store_as(s.factor.at + k, local_damping_factor(c.local_damping, fx * fx + fy * fy, px * px + py * py));
      }
    }
}

/// Local damping; velocities and places after the step, to the rows.
template <class T, class Rows>
inline __attribute__((always_inline)) void move_discs(const StepConstants& c, const GrainArrays& g, long first,
                                                      long count, DiscColumns& s, PartialSums<T::W>* momentum,
                                                      typename Lanes<T::W>::V& fastest,
                                                      PartialSums<T::W>& lost_locally) {
  constexpr int W = T::W;
  using V = typename Lanes<W>::V;
  constexpr int length = Rows::length;
  const double half_dt = 0.5 * c.dt;
  for (long eight = 0; eight < count; eight += 8)
#pragma GCC unroll 2
    for (int part = 0; part < 8 / W; ++part) {
      const long k = eight + part * W, at = first + k;
      const V inverse_mass = load_as<V>(g.inverse_mass + at), inverse_inertia = load_as<V>(g.inverse_inertia + at);
      V fx = load_as<V>(s.fx.at + k), fy = load_as<V>(s.fy.at + k), torque = load_as<V>(s.torque.at + k);
      V u = load_as<V>(s.u.at + k), v = load_as<V>(s.v.at + k);
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
        [[maybe_unused]] const V free_x = fx, free_y = fy, free_torque = torque;
        const V px = load_as<V>(s.px.at + k), py = load_as<V>(s.py.at + k);
        const V pw = w + half_dt * (torque * inverse_inertia);
        if constexpr (T::damping == KernelDamping::vector) {
          const V factor = load_as<V>(s.factor.at + k);
          fx = fx - factor * px;
          fy = fy - factor * py;
        } else {
          fx = damped_component(c.local_damping, fx, px);
          fy = damped_component(c.local_damping, fy, py);
        }
        torque = damped_component(c.local_damping, torque, pw);
        if (T::AtRate && c.losses)
          lost_locally.add(part, c.dt * ((free_x - fx) * px + (free_y - fy) * py + (free_torque - torque) * pw));
      }
      const V ax = c.dt * (fx * inverse_mass), ay = c.dt * (fy * inverse_mass);
      if constexpr (T::AtRate) {
        const V pu = (c.momentum_map[0] * u + c.momentum_map[1] * v) + (c.force_map[0] * ax + c.force_map[1] * ay);
        const V pv = (c.momentum_map[3] * u + c.momentum_map[4] * v) + (c.force_map[3] * ax + c.force_map[4] * ay);
        u = pu;
        v = pv;
        w = w + c.spin_shift[2];
      } else {
        u = u + ax;
        v = v + ay;
      }
      w = w + c.dt * (torque * inverse_inertia);
      const V mass = load_as<V>(g.mass + at);
      momentum[0].add(part, mass * u);
      momentum[1].add(part, mass * v);
      if constexpr (!Rows::turns) {
        const V squared = u * u + v * v;
        fastest = (squared > fastest) ? squared : fastest;
      }
      const V x = load_as<V>(s.x.at + k), y = load_as<V>(s.y.at + k);
      const V to[4] = {(c.map.xx * x + c.map.xy * y) + (c.velocity_map.xx * u + c.velocity_map.xy * v),
                       c.map.yy * y + c.velocity_map.yy * v, u, v};
      rows_of<W>(to, row, length);
      if constexpr (Rows::turns) {
        Rows::template turn<W>(c, g, at, u, v, w, spin_and_axis, fastest);
      } else {
        double spins[W];
        std::memcpy(spins, &w, sizeof(V));
#pragma GCC unroll 8
        for (int lane = 0; lane < W; ++lane) row[length * lane + 4] = spins[lane];
      }
    }
}

/// What the grain loop in the plane asks of a shape: the length of its rows, and what turns with the grain.
struct DiscRows {
  static constexpr int length = Disc::row_length;
  static constexpr bool turns = false;
};

/// Grains in 2D. A chunk at a time in passes, as the pair loops (kernels/pairs.hpp).
template <class Rows, class T>
void plane_grains(const StepConstants& constants, const GrainArrays& grains, const PairArrays& pairs, long begin,
                  long end, StepSums* sums) {
  constexpr int W = T::W, narrow = W < 4 ? W : 4;
  // Copies that no store can change (kernels/pairs.hpp).
  const StepConstants c = constants;
  const GrainArrays g = grains;
  const PairArrays p = pairs;
  PartialSums<W> momentum[2], lost_locally, lost_globally;
  typename Lanes<W>::V fastest = {};
  DiscColumns s;
  TaskRows task_sums;
  for (long chunk = begin; chunk < end; chunk += chunk_grains) {
    const long count = end - chunk < chunk_grains ? end - chunk : chunk_grains;
    if (g.before_chunk != nullptr) g.before_chunk(g.sweep, chunk + count);
    gather_disc_forces<narrow>(g, p, chunk, count, task_sums);
    if (g.resultants == nullptr)
      damp_discs<T, Rows::length, false>(c, g, chunk, count, task_sums, s, lost_globally);
    else
      damp_discs<T, Rows::length, true>(c, g, chunk, count, task_sums, s, lost_globally);
    move_discs<T, Rows>(c, g, chunk, count, s, momentum, fastest, lost_locally);
  }
  sums->momentum[0] = momentum[0].total();
  sums->momentum[1] = momentum[1].total();
  sums->momentum[2] = 0;
  sums->largest_speed_squared = largest_of(fastest);
  sums->local_damping = lost_locally.total();
  sums->global_damping = lost_globally.total();
}

}  // namespace
}  // namespace rvelab
