// The grain loop of spheres (integrate.hpp).
#pragma once

#include "rvelab/contact/damping.hpp"
#include "rvelab/solver/kernels/integrate.hpp"

namespace rvelab {
namespace {

/// One row of a 3x3 map applied to a column vector.
template <class V>
inline __attribute__((always_inline)) V mapped(const double* row, V x, V y, V z) {
  return row[0] * x + (row[1] * y + row[2] * z);
}
template <class V>
inline __attribute__((always_inline)) Triple<V> mapped(const double* rows, const Triple<V>& v) {
  return {mapped(rows, v.x, v.y, v.z), mapped(rows + 3, v.x, v.y, v.z), mapped(rows + 6, v.x, v.y, v.z)};
}

/// What the passes over a chunk of spheres hand on.
struct SphereColumns {
  TripleColumn force, torque;  ///< resultants
  TripleColumn velocity, spin;
  TripleColumn ahead, spin_ahead;  ///< velocity and spin half a step ahead
  ScratchColumn along, about;      ///< how much of them local damping takes off force and torque
};

/// Sum of force rows: force and, apart, n x f_t. With eight lanes a row is one vector (1,000 spheres: 0.977 of the
/// time).
template <int W>
struct RowSum {
  using L = Lanes<W>;
  using Quad = typename L::Quad;
  Quad force = L::broadcast(0.0), turn = L::broadcast(0.0);
  inline __attribute__((always_inline)) void add(const double* row) {
    force = L::add(force, quad_at<W>(row));
    turn = L::add(turn, quad_at<W>(row + 4));
  }
  inline __attribute__((always_inline)) Quad first_half() const { return force; }
  inline __attribute__((always_inline)) Quad second_half() const { return turn; }
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

/// Resultant forces and torques of a chunk of spheres. Torque on either grain of a pair: -(r - delta/2) n x f_t; the
/// moment of rolling is minus on i, plus on j.
template <int W, bool Rolling>
inline __attribute__((always_inline)) void gather_sphere_forces(const GrainArrays& g, const PairArrays& p, long first,
                                                                long count, TaskRows& forces, TaskRows& torques) {
  constexpr int narrow = W < 4 ? W : 4;
  using L = Lanes<narrow>;
  using Quad = typename L::Quad;
  const std::int32_t* slot = g.slots + 4L * g.slot_begin[first / 2];
  for (long block = first / 2; block < (first + count) / 2; ++block) {
    const std::int32_t* last = g.slots + 4L * g.slot_begin[block + 1];
    RowSum<W> sum[4];
    Quad arm[4];
    for (int k = 0; k < 4; ++k) arm[k] = L::broadcast(0.0);
    double moment[4][4] = {};
    for (; slot != last; slot += 4)
#pragma GCC unroll 4
      for (int k = 0; k < 4; ++k) {
        const double* row = p.force + slot[k];
        sum[k].add(row);
        arm[k] = L::add(arm[k], L::mul(L::broadcast(row[3]), quad_at<narrow>(row + 4)));
        if constexpr (Rolling)
          for (int m = 0; m < 3; ++m) moment[k][m] += p.moment[m][slot[k] / 8];
      }
#pragma GCC unroll 4
    for (int k = 0; k < 4; ++k) {
      const std::uint16_t task = g.tasks[4 * block + k];
      const double radius = g.rows[12 * first + 3 * (task % (4 * chunk_grains)) + 3];
      Quad torque = L::sub(arm[k], L::mul(L::broadcast(radius), sum[k].second_half()));
      if constexpr (Rolling)
        torque = L::add(torque, L::mul(L::broadcast(task < 4 * chunk_grains ? 1.0 : -1.0), quad_at<narrow>(moment[k])));
      store_as(forces.of(task), sum[k].first_half());
      store_as(torques.of(task), torque);
    }
  }
}

/// Resultants of a chunk, global damping and the factors of the local one; as for discs, this pass ends with the roots.
/// What interactions give comes here, where a compiler has both (in the gathering pass: 5 instructions a grain more).
template <class T, bool interactions>
inline __attribute__((always_inline)) void damp_spheres(const StepConstants& c, const GrainArrays& g, long first,
                                                        long count, const TaskRows& forces, const TaskRows& torques,
                                                        SphereColumns& s, PartialSums<T::W>& lost_globally) {
  constexpr int W = T::W;
  using L = Lanes<W>;
  using V = typename L::V;
  const V half_dt = V{} + 0.5 * c.dt;
  const Triple<V> mean = {V{} + c.mean_velocity[0], V{} + c.mean_velocity[1], V{} + c.mean_velocity[2]};
  for (long eight = 0; eight < count; eight += 8)
#pragma GCC unroll 2
    for (int part = 0; part < 8 / W; ++part) {
      const long k = eight + part * W, at = first + k;
      const V one = V{} + 1.0;
      typename L::Quad quads[W];
      V a[4];
      for (int lane = 0; lane < W; ++lane)
        quads[lane] = L::sub(quad_at<W>(forces.as_j(k + lane)), quad_at<W>(forces.as_i(k + lane)));
      if constexpr (interactions)
        for (int lane = 0; lane < W; ++lane)
          quads[lane] = L::add(quads[lane], taken<W>(g.resultants + 12 * (at + lane)));
      L::transpose(quads, a);
      Triple<V> f = {a[0], a[1], a[2]};
      for (int lane = 0; lane < W; ++lane)
        quads[lane] = L::add(quad_at<W>(torques.as_j(k + lane)), quad_at<W>(torques.as_i(k + lane)));
      if constexpr (interactions)
        for (int lane = 0; lane < W; ++lane)
          quads[lane] = L::add(quads[lane], taken<W>(g.resultants + 12 * (at + lane) + 4));
      L::transpose(quads, a);
      const Triple<V> t = {a[0], a[1], a[2]};
      const double* row = g.rows + 12 * at;
      columns_of<W>(row + 4, 12, a);
      const Triple<V> v = plus(Triple<V>{a[0], a[1], a[2]}, -one, mean);
      s.velocity.store(k, v);
      columns_of<W>(row + 8, 12, a);
      const Triple<V> w = {a[0], a[1], a[2]};
      s.spin.store(k, w);
      if constexpr (T::AtRate) {
        if (c.global_viscous != 0.0) {
          f = plus(f, V{} - c.global_viscous, v);
          if (c.losses) lost_globally.add(part, c.dt * c.global_viscous * dot(v, v));
        }
      }
      s.force.store(k, f);
      s.torque.store(k, t);
      if constexpr (T::damping != KernelDamping::none) {
        const V inverse_mass = load_as<V>(g.inverse_mass + at), inverse_inertia = load_as<V>(g.inverse_inertia + at);
        const Triple<V> pv = plus(v, half_dt, times(inverse_mass, f));
        const Triple<V> pw = plus(w, half_dt, times(inverse_inertia, t));
        s.ahead.store(k, pv);
        s.spin_ahead.store(k, pw);
        if constexpr (T::damping == KernelDamping::vector) {
          store_as(s.along.at + k, local_damping_factor(c.local_damping, dot(f, f), dot(pv, pv)));
          store_as(s.about.at + k, local_damping_factor(c.local_damping, dot(t, t), dot(pw, pw)));
        }
      }
    }
}

/// Local damping; velocities and places after the step, to the rows.
template <class T>
inline __attribute__((always_inline)) void move_spheres(const StepConstants& c, const GrainArrays& g, long first,
                                                        long count, SphereColumns& s, PartialSums<T::W>* momentum,
                                                        typename Lanes<T::W>::V& fastest,
                                                        PartialSums<T::W>& lost_locally) {
  constexpr int W = T::W;
  using V = typename Lanes<T::W>::V;
  const V dt = V{} + c.dt, one = V{} + 1.0;
  for (long eight = 0; eight < count; eight += 8)
#pragma GCC unroll 2
    for (int part = 0; part < 8 / W; ++part) {
      const long k = eight + part * W, at = first + k;
      Triple<V> f = s.force.load<V>(k), t = s.torque.load<V>(k);
      if constexpr (T::damping != KernelDamping::none) {
        [[maybe_unused]] const Triple<V> free_f = f, free_t = t;
        const Triple<V> pv = s.ahead.load<V>(k), pw = s.spin_ahead.load<V>(k);
        if constexpr (T::damping == KernelDamping::vector) {
          f = plus(f, -load_as<V>(s.along.at + k), pv);
          t = plus(t, -load_as<V>(s.about.at + k), pw);
        } else {
          f = {damped_component(c.local_damping, f.x, pv.x), damped_component(c.local_damping, f.y, pv.y),
               damped_component(c.local_damping, f.z, pv.z)};
          t = {damped_component(c.local_damping, t.x, pw.x), damped_component(c.local_damping, t.y, pw.y),
               damped_component(c.local_damping, t.z, pw.z)};
        }
        if (T::AtRate && c.losses)
          lost_locally.add(part, c.dt * (dot(plus(free_f, -one, f), pv) + dot(plus(free_t, -one, t), pw)));
      }
      Triple<V> v = s.velocity.load<V>(k), w = s.spin.load<V>(k);
      const Triple<V> a = times(dt, times(load_as<V>(g.inverse_mass + at), f));
      if constexpr (T::AtRate) {
        v = plus(mapped(c.momentum_map, v), one, mapped(c.force_map, a));
        w = mapped(c.spin_map, w);
        w = {w.x + c.spin_shift[0], w.y + c.spin_shift[1], w.z + c.spin_shift[2]};
      } else {
        v = plus(v, one, a);
      }
      w = plus(w, dt, times(load_as<V>(g.inverse_inertia + at), t));
      const V mass = load_as<V>(g.mass + at);
      momentum[0].add(part, mass * v.x);
      momentum[1].add(part, mass * v.y);
      momentum[2].add(part, mass * v.z);
      const V squared = dot(v, v);
      fastest = (squared > fastest) ? squared : fastest;
      const UpperTriangle &A = c.map, &B = c.velocity_map;
      double* row = g.rows + 12 * at;
      V place[4];
      columns_of<W>(row, 12, place);
      const Triple<V> x = {place[0], place[1], place[2]};
      const V radius = place[3];
      const V places[4] = {(A.xx * x.x + (A.xy * x.y + A.xz * x.z)) + (B.xx * v.x + (B.xy * v.y + B.xz * v.z)),
                           (A.yy * x.y + A.yz * x.z) + (B.yy * v.y + B.yz * v.z), A.zz * x.z + B.zz * v.z, radius};
      const V velocities[4] = {v.x, v.y, v.z, V{}};
      const V spins[4] = {w.x, w.y, w.z, radius};
      rows_of<W>(places, row, 12);
      rows_of<W>(velocities, row + 4, 12);
      rows_of<W>(spins, row + 8, 12);
    }
}

/// Spheres in 3D.
template <class T>
void sphere_grains(const StepConstants& constants, const GrainArrays& grains, const PairArrays& pairs, long begin,
                   long end, StepSums* sums) {
  constexpr int W = T::W;
  // Copies that no store can change (kernels/pairs.hpp).
  const StepConstants c = constants;
  const GrainArrays g = grains;
  const PairArrays p = pairs;
  PartialSums<W> momentum[3], lost_locally, lost_globally;
  typename Lanes<W>::V fastest = {};
  SphereColumns s;
  TaskRows forces, torques;
  for (long chunk = begin; chunk < end; chunk += chunk_grains) {
    const long count = end - chunk < chunk_grains ? end - chunk : chunk_grains;
    if (g.before_chunk != nullptr) g.before_chunk(g.sweep, chunk + count);
    gather_sphere_forces<W, T::Rolling>(g, p, chunk, count, forces, torques);
    if (g.resultants == nullptr)
      damp_spheres<T, false>(c, g, chunk, count, forces, torques, s, lost_globally);
    else
      damp_spheres<T, true>(c, g, chunk, count, forces, torques, s, lost_globally);
    move_spheres<T>(c, g, chunk, count, s, momentum, fastest, lost_locally);
  }
  for (int k = 0; k < 3; ++k) sums->momentum[k] = momentum[k].total();
  sums->largest_speed_squared = largest_of(fastest);
  sums->local_damping = lost_locally.total();
  sums->global_damping = lost_globally.total();
}

}  // namespace
}  // namespace rvelab
