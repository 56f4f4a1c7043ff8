// The grain loops: gather the force rows of each grain's pairs in the order of the pairs, damp, integrate, move.
//
//   v' <- P (v' - mean) + R dt (f - damping)/m      P, R from D + 2 Omega at dt > 0, the identity at dt = 0
//   w' <- w' + dt T/I (+ frame terms at dt > 0)
//   x  <- A x + dt B v'                             A, B upper triangular, A = L1 L0^-1 exactly
// (design 4). Sums over grains go into eight interleaved partial sums whatever the number of lanes, so that every
// instruction set adds in the same order.
#pragma once

#include "rvelab/contact/damping.hpp"
#include "rvelab/solver/kernel_pairs.hpp"

namespace rvelab {
namespace {

template <int W_, bool Rolling_, bool Dynamic_, KernelDamping damping_>
struct GrainTraits {
  static constexpr int W = W_;
  static constexpr bool Rolling = Rolling_, Dynamic = Dynamic_;
  static constexpr KernelDamping damping = damping_;
};

/// Eight partial sums, filled W at a time; total() adds them in a fixed order.
template <int W>
struct PartialSums {
  using V = typename Lanes<W>::V;
  V part[8 / W] = {};
  inline __attribute__((always_inline)) void add(long at, V value) {
    V& here = part[(at / W) % (8 / W)];
    here = here + value;
  }
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

/// Grains of one chunk: their resultants stay in the first-level cache between gather and integration.
constexpr long chunk_grains = 64;

/// A row {x, y, z, 0} or, of discs, {fx, fy, T, -} for every grain of a chunk.
struct alignas(64) ScratchRows {
  double at[4 * chunk_grains];
};

/// Resultants of a chunk of discs: sum of the rows of pairs in which they are j, less forces and plus T_i of those in
/// which they are i.
template <int W>
inline __attribute__((always_inline)) void gather_disc_forces(const GrainArrays& g, const PairArrays& p, long first,
                                                              long count, ScratchRows& resultants) {
  using L = Lanes<W>;
  using Quad = typename L::Quad;
  const Quad sign = quad<W>(-1.0, -1.0, 1.0, 1.0);
  for (long block = 0; block < count; block += 4) {
    const long b = (first + block) / 4;
    const std::int32_t* slot = g.slots + 8L * g.slot_begin[b];
    const std::int32_t* last = g.slots + 8L * g.slot_begin[b + 1];
    Quad in[4], out[4];
    for (int k = 0; k < 4; ++k) in[k] = out[k] = L::broadcast(0.0);
    for (; slot != last; slot += 8)
#pragma GCC unroll 4
      for (int k = 0; k < 4; ++k) {
        in[k] = L::add(in[k], quad_at<W>(p.force + slot[k]));
        out[k] = L::add(out[k], quad_at<W>(p.force + slot[4 + k]));
      }
    for (int k = 0; k < 4; ++k)
      store_as(resultants.at + 4 * (block + k), L::add(in[k], L::mul(sign, L::swap_last(out[k]))));
  }
}

/// Discs in 2D.
template <class T>
void disc_grains(const StepConstants& constants, const GrainArrays& grains, const PairArrays& pairs, long begin,
                 long end, StepSums* sums) {
  constexpr int W = T::W;
  using L = Lanes<W>;
  using V = typename L::V;
  using Quad = typename L::Quad;
  // Copies that no store can change (kernel_pairs.hpp).
  const StepConstants c = constants;
  const GrainArrays g = grains;
  const PairArrays p = pairs;
  const double half_dt = 0.5 * c.dt;
  PartialSums<W> momentum_x, momentum_y, lost_locally, lost_globally;
  V fastest = V{};
  ScratchRows resultants;
  for (long chunk = begin; chunk < end; chunk += chunk_grains) {
    const long count = end - chunk < chunk_grains ? end - chunk : chunk_grains;
    gather_disc_forces<W>(g, p, chunk, count, resultants);
    for (long k = 0; k < count; k += W) {
      const long at = chunk + k;
      Quad first[W], second[W], resultant[W];
      for (int lane = 0; lane < W; ++lane) {
        first[lane] = quad_at<W>(g.rows + 8 * (at + lane));
        second[lane] = quad_at<W>(g.rows + 8 * (at + lane) + 4);
        resultant[lane] = quad_at<W>(resultants.at + 4 * (k + lane));
      }
      V f[4], a[4], s[4];
      L::transpose(resultant, f);
      L::transpose(first, a);
      L::transpose(second, s);
      V fx = f[0], fy = f[1], torque = f[2];
      const V inverse_mass = load_as<V>(g.inverse_mass + at), inverse_inertia = load_as<V>(g.inverse_inertia + at);
      V u = a[2] - c.mean_velocity[0], v = a[3] - c.mean_velocity[1], w = s[0];
      if constexpr (T::Dynamic) {
        if (c.global_viscous != 0.0) {
          fx = fx - c.global_viscous * u;
          fy = fy - c.global_viscous * v;
          lost_globally.add(at, c.dt * c.global_viscous * (u * u + v * v));
        }
      }
      [[maybe_unused]] const V free_x = fx, free_y = fy, free_torque = torque;
      if constexpr (T::damping != KernelDamping::none) {
        const V px = u + half_dt * (fx * inverse_mass), py = v + half_dt * (fy * inverse_mass);
        const V pw = w + half_dt * (torque * inverse_inertia);
        if constexpr (T::damping == KernelDamping::vector) {
          const V factor = local_damping_factor(c.local_damping, fx * fx + fy * fy, px * px + py * py, SquareRoot{});
          fx = fx - factor * px;
          fy = fy - factor * py;
        } else {
          fx = damped_component(c.local_damping, fx, px);
          fy = damped_component(c.local_damping, fy, py);
        }
        torque = damped_component(c.local_damping, torque, pw);
        if constexpr (T::Dynamic)
          lost_locally.add(at, c.dt * ((free_x - fx) * px + (free_y - fy) * py + (free_torque - torque) * pw));
      }
      const V ax = c.dt * (fx * inverse_mass), ay = c.dt * (fy * inverse_mass);
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
      w = w + c.dt * (torque * inverse_inertia);
      const V mass = load_as<V>(g.mass + at);
      momentum_x.add(at, mass * u);
      momentum_y.add(at, mass * v);
      const V squared = u * u + v * v;
      fastest = (squared > fastest) ? squared : fastest;
      a[0] = (c.map.xx * a[0] + c.map.xy * a[1]) + (c.velocity_map.xx * u + c.velocity_map.xy * v);
      a[1] = c.map.yy * a[1] + c.velocity_map.yy * v;
      a[2] = u;
      a[3] = v;
      s[0] = w;
      s[1] = s[2] * w;
      L::untranspose(a, first);
      L::untranspose(s, second);
      for (int lane = 0; lane < W; ++lane) {
        store_as(g.rows + 8 * (at + lane), first[lane]);
        store_as(g.rows + 8 * (at + lane) + 4, second[lane]);
      }
    }
  }
  sums->momentum[0] = momentum_x.total();
  sums->momentum[1] = momentum_y.total();
  sums->momentum[2] = 0;
  sums->largest_speed_squared = largest_of(fastest);
  sums->local_damping = lost_locally.total();
  sums->global_damping = lost_globally.total();
}

/// One row of a 3x3 map applied to a column vector.
template <class V>
inline __attribute__((always_inline)) V mapped(const double* row, V x, V y, V z) {
  return row[0] * x + (row[1] * y + row[2] * z);
}

/// Resultant forces and torques of a chunk of spheres. Torque on either grain of a pair: -(r - delta/2) n x f_t; the
/// moment of rolling is minus on i, plus on j.
template <int W, bool Rolling>
inline __attribute__((always_inline)) void gather_sphere_forces(const GrainArrays& g, const PairArrays& p, long first,
                                                                long count, ScratchRows& forces, ScratchRows& torques) {
  using L = Lanes<W>;
  using Quad = typename L::Quad;
  for (long block = 0; block < count; block += 4) {
    const long b = (first + block) / 4;
    const std::int32_t* begin = g.slots + 8L * g.slot_begin[b];
    const std::int32_t* last = g.slots + 8L * g.slot_begin[b + 1];
    for (int k = 0; k < 4; ++k) {
      // Both sides are summed apart: which pairs share a slot depends on the list, and must not show in the sum.
      Quad in = L::broadcast(0.0), turn_in = in, arm_in = in, out = in, turn_out = in, arm_out = in;
      double moment_in[4] = {}, moment_out[4] = {};
      for (const std::int32_t* slot = begin + k; slot < last; slot += 8) {
        const double *row_in = p.force + slot[0], *row_out = p.force + slot[4];
        const Quad a = quad_at<W>(row_in + 4), c = quad_at<W>(row_out + 4);
        in = L::add(in, quad_at<W>(row_in));
        out = L::add(out, quad_at<W>(row_out));
        turn_in = L::add(turn_in, a);
        turn_out = L::add(turn_out, c);
        arm_in = L::add(arm_in, L::mul(L::broadcast(row_in[3]), a));
        arm_out = L::add(arm_out, L::mul(L::broadcast(row_out[3]), c));
        if constexpr (Rolling)
          for (int m = 0; m < 3; ++m) {
            moment_in[m] += p.moment[m][slot[0] / 8];
            moment_out[m] += p.moment[m][slot[4] / 8];
          }
      }
      const double radius = g.rows[12 * (first + block + k) + 3];
      store_as(forces.at + 4 * (block + k), L::sub(in, out));
      Quad torque = L::sub(L::add(arm_in, arm_out), L::mul(L::broadcast(radius), L::add(turn_in, turn_out)));
      if constexpr (Rolling) torque = L::add(torque, L::sub(quad_at<W>(moment_in), quad_at<W>(moment_out)));
      store_as(torques.at + 4 * (block + k), torque);
    }
  }
}

/// Spheres in 3D.
template <class T>
void sphere_grains(const StepConstants& constants, const GrainArrays& grains, const PairArrays& pairs, long begin,
                   long end, StepSums* sums) {
  constexpr int W = T::W;
  using L = Lanes<W>;
  using V = typename L::V;
  using Quad = typename L::Quad;
  // Copies that no store can change (kernel_pairs.hpp).
  const StepConstants c = constants;
  const GrainArrays g = grains;
  const PairArrays p = pairs;
  const double half_dt = 0.5 * c.dt;
  PartialSums<W> momentum_x, momentum_y, momentum_z, lost_locally, lost_globally;
  V fastest = V{};
  ScratchRows forces, torques;
  for (long chunk = begin; chunk < end; chunk += chunk_grains) {
    const long count = end - chunk < chunk_grains ? end - chunk : chunk_grains;
    gather_sphere_forces<W, T::Rolling>(g, p, chunk, count, forces, torques);
    for (long place = 0; place < count; place += W) {
      const long at = chunk + place;
      Quad force[W], couple[W], rows[3][W];
      for (int lane = 0; lane < W; ++lane) {
        force[lane] = quad_at<W>(forces.at + 4 * (place + lane));
        couple[lane] = quad_at<W>(torques.at + 4 * (place + lane));
        for (int part = 0; part < 3; ++part) rows[part][lane] = quad_at<W>(g.rows + 12 * (at + lane) + 4 * part);
      }
      V f[4], t[4], x[4], v[4], w[4];
      L::transpose(force, f);
      L::transpose(couple, t);
      L::transpose(rows[0], x);
      L::transpose(rows[1], v);
      L::transpose(rows[2], w);
      const V inverse_mass = load_as<V>(g.inverse_mass + at), inverse_inertia = load_as<V>(g.inverse_inertia + at);
      for (int k = 0; k < 3; ++k) v[k] = v[k] - c.mean_velocity[k];
      if constexpr (T::Dynamic) {
        if (c.global_viscous != 0.0) {
          for (int k = 0; k < 3; ++k) f[k] = f[k] - c.global_viscous * v[k];
          lost_globally.add(at, c.dt * c.global_viscous * (v[0] * v[0] + (v[1] * v[1] + v[2] * v[2])));
        }
      }
      [[maybe_unused]] const V free_f[3] = {f[0], f[1], f[2]}, free_t[3] = {t[0], t[1], t[2]};
      if constexpr (T::damping != KernelDamping::none) {
        V pv[3], pw[3];
        for (int k = 0; k < 3; ++k) {
          pv[k] = v[k] + half_dt * (f[k] * inverse_mass);
          pw[k] = w[k] + half_dt * (t[k] * inverse_inertia);
        }
        if constexpr (T::damping == KernelDamping::vector) {
          const V along = local_damping_factor(c.local_damping, f[0] * f[0] + (f[1] * f[1] + f[2] * f[2]),
                                               pv[0] * pv[0] + (pv[1] * pv[1] + pv[2] * pv[2]), SquareRoot{});
          const V about = local_damping_factor(c.local_damping, t[0] * t[0] + (t[1] * t[1] + t[2] * t[2]),
                                               pw[0] * pw[0] + (pw[1] * pw[1] + pw[2] * pw[2]), SquareRoot{});
          for (int k = 0; k < 3; ++k) {
            f[k] = f[k] - along * pv[k];
            t[k] = t[k] - about * pw[k];
          }
        } else {
          for (int k = 0; k < 3; ++k) {
            f[k] = damped_component(c.local_damping, f[k], pv[k]);
            t[k] = damped_component(c.local_damping, t[k], pw[k]);
          }
        }
        if constexpr (T::Dynamic) {
          V lost = V{};
          for (int k = 0; k < 3; ++k) lost = lost + ((free_f[k] - f[k]) * pv[k] + (free_t[k] - t[k]) * pw[k]);
          lost_locally.add(at, c.dt * lost);
        }
      }
      const V a[3] = {c.dt * (f[0] * inverse_mass), c.dt * (f[1] * inverse_mass), c.dt * (f[2] * inverse_mass)};
      if constexpr (T::Dynamic) {
        V next[3], turned[3];
        for (int k = 0; k < 3; ++k) {
          next[k] = mapped(c.momentum_map + 3 * k, v[0], v[1], v[2]) + mapped(c.force_map + 3 * k, a[0], a[1], a[2]);
          turned[k] = mapped(c.spin_map + 3 * k, w[0], w[1], w[2]) + c.spin_shift[k];
        }
        for (int k = 0; k < 3; ++k) {
          v[k] = next[k];
          w[k] = turned[k];
        }
      } else {
        for (int k = 0; k < 3; ++k) v[k] = v[k] + a[k];
      }
      for (int k = 0; k < 3; ++k) w[k] = w[k] + c.dt * (t[k] * inverse_inertia);
      const V mass = load_as<V>(g.mass + at);
      momentum_x.add(at, mass * v[0]);
      momentum_y.add(at, mass * v[1]);
      momentum_z.add(at, mass * v[2]);
      const V squared = v[0] * v[0] + (v[1] * v[1] + v[2] * v[2]);
      fastest = (squared > fastest) ? squared : fastest;
      const UpperTriangle &A = c.map, &B = c.velocity_map;
      x[0] = (A.xx * x[0] + (A.xy * x[1] + A.xz * x[2])) + (B.xx * v[0] + (B.xy * v[1] + B.xz * v[2]));
      x[1] = (A.yy * x[1] + A.yz * x[2]) + (B.yy * v[1] + B.yz * v[2]);
      x[2] = A.zz * x[2] + B.zz * v[2];
      L::untranspose(x, rows[0]);
      L::untranspose(v, rows[1]);
      L::untranspose(w, rows[2]);
      for (int lane = 0; lane < W; ++lane)
        for (int part = 0; part < 3; ++part) store_as(g.rows + 12 * (at + lane) + 4 * part, rows[part][lane]);
    }
  }
  sums->momentum[0] = momentum_x.total();
  sums->momentum[1] = momentum_y.total();
  sums->momentum[2] = momentum_z.total();
  sums->largest_speed_squared = largest_of(fastest);
  sums->local_damping = lost_locally.total();
  sums->global_damping = lost_globally.total();
}

}  // namespace
}  // namespace rvelab
