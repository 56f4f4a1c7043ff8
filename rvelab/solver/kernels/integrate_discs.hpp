// The grain loop of discs (integrate.hpp).
#pragma once

#include "rvelab/contact/damping.hpp"
#include "rvelab/solver/kernels/integrate.hpp"

namespace rvelab {
namespace {

/// What the passes over a chunk of discs hand on; the number of lanes is chosen for each pass by itself.
struct DiscColumns {
  ScratchColumn fx, fy, torque;  ///< resultants, in the end damped
  ScratchColumn x, y, u, v, w;
};

/// Resultants of a chunk of discs: sum of the force rows of pairs in which they are j, less forces and plus T_i of
/// those in which they are i.
template <int W>
inline __attribute__((always_inline)) void gather_disc_forces(const GrainArrays& g, const PairArrays& p, long first,
                                                              long count, DiscColumns& out) {
  using L = Lanes<W>;
  using Quad = typename L::Quad;
  using V = typename L::V;
  TaskRows sums;
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
  for (long k = 0; k < count; k += W) {
    Quad net[W];
    for (int lane = 0; lane < W; ++lane)
      net[lane] = L::add(quad_at<W>(sums.as_j(k + lane)), L::seen_from_i(quad_at<W>(sums.as_i(k + lane))));
    V columns[4];
    L::transpose(net, columns);
    store_as(out.fx.at + k, columns[0]);
    store_as(out.fy.at + k, columns[1]);
    store_as(out.torque.at + k, columns[2]);
  }
}

/// Damps the resultants.
template <class T>
inline __attribute__((always_inline)) void damp_discs(const StepConstants& c, const GrainArrays& g, long first,
                                                      long count, DiscColumns& s, PartialSums<T::W>& lost_locally,
                                                      PartialSums<T::W>& lost_globally) {
  using V = typename Lanes<T::W>::V;
  const double half_dt = 0.5 * c.dt;
  for (long eight = 0; eight < count; eight += 8)
#pragma GCC unroll 2
    for (int part = 0; part < 8 / T::W; ++part) {
      const long k = eight + part * T::W, at = first + k;
      V fx = load_as<V>(s.fx.at + k), fy = load_as<V>(s.fy.at + k), torque = load_as<V>(s.torque.at + k);
      const V u = load_as<V>(s.u.at + k) - c.mean_velocity[0], v = load_as<V>(s.v.at + k) - c.mean_velocity[1];
      if constexpr (T::Dynamic) {
        if (c.global_viscous != 0.0) {
          fx = fx - c.global_viscous * u;
          fy = fy - c.global_viscous * v;
          if (c.losses) lost_globally.add(part, c.dt * c.global_viscous * (u * u + v * v));
        }
      }
      if constexpr (T::damping != KernelDamping::none) {
        [[maybe_unused]] const V free_x = fx, free_y = fy, free_torque = torque;
        const V inverse_mass = load_as<V>(g.inverse_mass + at), inverse_inertia = load_as<V>(g.inverse_inertia + at);
        const V px = u + half_dt * (fx * inverse_mass), py = v + half_dt * (fy * inverse_mass);
        const V pw = load_as<V>(s.w.at + k) + half_dt * (torque * inverse_inertia);
        if constexpr (T::damping == KernelDamping::vector) {
          const V factor = local_damping_factor(c.local_damping, fx * fx + fy * fy, px * px + py * py);
          fx = fx - factor * px;
          fy = fy - factor * py;
        } else {
          fx = damped_component(c.local_damping, fx, px);
          fy = damped_component(c.local_damping, fy, py);
        }
        torque = damped_component(c.local_damping, torque, pw);
        if (T::Dynamic && c.losses)
          lost_locally.add(part, c.dt * ((free_x - fx) * px + (free_y - fy) * py + (free_torque - torque) * pw));
        store_as(s.torque.at + k, torque);
      }
      store_as(s.fx.at + k, fx);
      store_as(s.fy.at + k, fy);
    }
}

/// Velocities and places after the step.
template <class T>
inline __attribute__((always_inline)) void move_discs(const StepConstants& c, const GrainArrays& g, long first,
                                                      long count, DiscColumns& s, PartialSums<T::W>* momentum,
                                                      typename Lanes<T::W>::V& fastest) {
  using V = typename Lanes<T::W>::V;
  for (long eight = 0; eight < count; eight += 8)
#pragma GCC unroll 2
    for (int part = 0; part < 8 / T::W; ++part) {
      const long k = eight + part * T::W, at = first + k;
      const V inverse_mass = load_as<V>(g.inverse_mass + at), inverse_inertia = load_as<V>(g.inverse_inertia + at);
      V u = load_as<V>(s.u.at + k) - c.mean_velocity[0], v = load_as<V>(s.v.at + k) - c.mean_velocity[1];
      V w = load_as<V>(s.w.at + k);
      const V ax = c.dt * (load_as<V>(s.fx.at + k) * inverse_mass),
              ay = c.dt * (load_as<V>(s.fy.at + k) * inverse_mass);
      if constexpr (T::Dynamic) {
        const V pu = (c.momentum_map[0] * u + c.momentum_map[1] * v) + (c.force_map[0] * ax + c.force_map[1] * ay);
        const V pv = (c.momentum_map[3] * u + c.momentum_map[4] * v) + (c.force_map[3] * ax + c.force_map[4] * ay);
        u = pu;
        v = pv;
        w = w + c.spin_shift[2];
      } else {
        u = u + ax;
        v = v + ay;
      }
      w = w + c.dt * (load_as<V>(s.torque.at + k) * inverse_inertia);
      const V mass = load_as<V>(g.mass + at);
      momentum[0].add(part, mass * u);
      momentum[1].add(part, mass * v);
      const V squared = u * u + v * v;
      fastest = (squared > fastest) ? squared : fastest;
      const V x = load_as<V>(s.x.at + k), y = load_as<V>(s.y.at + k);
      store_as(s.x.at + k, (c.map.xx * x + c.map.xy * y) + (c.velocity_map.xx * u + c.velocity_map.xy * v));
      store_as(s.y.at + k, c.map.yy * y + c.velocity_map.yy * v);
      store_as(s.u.at + k, u);
      store_as(s.v.at + k, v);
      store_as(s.w.at + k, w);
    }
}

/// Grain rows to columns and back; shuffles cost the same at every width, so these keep to four lanes.
template <int W, int length>
inline __attribute__((always_inline)) void disc_rows_to_columns(const double* rows, long first, long count,
                                                                DiscColumns& s) {
  using V = typename Lanes<W>::V;
  for (long k = 0; k < count; k += W) {
    const double* row = rows + length * (first + k);
    V a[4];
    columns_of<W>(row, length, a);
    store_as(s.x.at + k, a[0]);
    store_as(s.y.at + k, a[1]);
    store_as(s.u.at + k, a[2]);
    store_as(s.v.at + k, a[3]);
    for (int lane = 0; lane < W; ++lane) s.w.at[k + lane] = row[length * lane + 4];
  }
}
template <int W, int length>
inline __attribute__((always_inline)) void disc_columns_to_rows(const DiscColumns& s, double* rows, long first,
                                                                long count) {
  using V = typename Lanes<W>::V;
  for (long k = 0; k < count; k += W) {
    double* row = rows + length * (first + k);
    const V a[4] = {load_as<V>(s.x.at + k), load_as<V>(s.y.at + k), load_as<V>(s.u.at + k), load_as<V>(s.v.at + k)};
    rows_of<W>(a, row, length);
    for (int lane = 0; lane < W; ++lane) row[length * lane + 4] = s.w.at[k + lane];
  }
}

/// What the grain loop in the plane asks of a shape: the length of its rows, and what turns with the grain.
struct DiscRows {
  static constexpr int length = 8;
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
  [[maybe_unused]] typename Lanes<narrow>::V fastest_with_turn = {};
  DiscColumns s;
  for (long chunk = begin; chunk < end; chunk += chunk_grains) {
    const long count = end - chunk < chunk_grains ? end - chunk : chunk_grains;
    disc_rows_to_columns<narrow, Rows::length>(g.rows, chunk, count, s);
    gather_disc_forces<narrow>(g, p, chunk, count, s);
    damp_discs<T>(c, g, chunk, count, s, lost_locally, lost_globally);
    move_discs<T>(c, g, chunk, count, s, momentum, fastest);
    disc_columns_to_rows<narrow, Rows::length>(s, g.rows, chunk, count);
    if constexpr (Rows::turns) Rows::template turn<T>(c, g, chunk, count, s, fastest_with_turn);
  }
  sums->momentum[0] = momentum[0].total();
  sums->momentum[1] = momentum[1].total();
  sums->momentum[2] = 0;
  sums->largest_speed_squared = Rows::turns ? largest_of(fastest_with_turn) : largest_of(fastest);
  sums->local_damping = lost_locally.total();
  sums->global_damping = lost_globally.total();
}

}  // namespace
}  // namespace rvelab
