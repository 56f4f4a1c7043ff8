// The loop over bodies, W at a time: damping, velocity, spin, orientation, place (loading/body_motion.hpp). Forces have
// been gathered on their members before, and these are placed after (body_members.hpp); a superellipsoid is placed
// here.
//
// At a rate the body turns freely by the Cayley rotation of t wm, R t wm in the cell frame; where the frame turns, the
// quaternion of its way back is put before. The spin of the whole turn is the Cayley vector of both over dt.
#pragma once

#include "rvelab/contact/damping.hpp"
#include "rvelab/solver/kernels/body_members.hpp"

namespace rvelab {
namespace {

/// Sums over the members of W bodies, `length` doubles a row, to columns.
template <int W>
inline __attribute__((always_inline)) void sum_in_space(const BodyArrays& b, long at,
                                                        Triple<typename Lanes<W>::V>& force,
                                                        Triple<typename Lanes<W>::V>& torque) {
  typename Lanes<W>::Quad forces[W], torques[W];
  for (int lane = 0; lane < W; ++lane) {
    RowSum<W> sum;
    const double* last = b.resultants + 8L * b.first[at + lane + 1];
    for (const double* row = b.resultants + 8L * b.first[at + lane]; row != last; row += 8) sum.add(row);
    forces[lane] = sum.first_half();
    torques[lane] = sum.second_half();
  }
  typename Lanes<W>::V column[4];
  Lanes<W>::transpose(forces, column);
  force = {column[0], column[1], column[2]};
  Lanes<W>::transpose(torques, column);
  torque = {column[0], column[1], column[2]};
}
template <int W>
inline __attribute__((always_inline)) void sum_in_plane(const BodyArrays& b, long at, typename Lanes<W>::V* column) {
  using L = Lanes<W>;
  typename L::Quad sums[W];
  for (int lane = 0; lane < W; ++lane) {
    sums[lane] = L::broadcast(0.0);
    const double* last = b.resultants + 4L * b.first[at + lane + 1];
    for (const double* row = b.resultants + 4L * b.first[at + lane]; row != last; row += 4)
      sums[lane] = L::add(sums[lane], quad_at<W>(row));
  }
  L::transpose(sums, column);
}

/// Cundall's damping of W forces, or torques, by the velocity or spin half a step ahead.
template <class V>
inline __attribute__((always_inline)) Triple<V> damped(const StepConstants& c, KernelDamping damping,
                                                       const Triple<V>& force, const Triple<V>& ahead) {
  if (damping == KernelDamping::vector)
    return minus(force, local_damping_factor(c.local_damping, dot(force, force), dot(ahead, ahead)), ahead);
  return {damped_component(c.local_damping, force.x, ahead.x), damped_component(c.local_damping, force.y, ahead.y),
          damped_component(c.local_damping, force.z, ahead.z)};
}

template <class V>
struct SpatialBody {
  Triple<V> position, velocity, spin;
  LaneTurn<V> turn;
};

/// Partial sums of a call.
template <int W>
struct BodySums {
  PartialSums<W> momentum[3], lost_locally, lost_globally;
  typename Lanes<W>::V fastest = {};
};

/// Row of a superellipsoid; its surface comes nearer by its turn too (assembly/oriented_bounds.hpp).
template <int W>
inline __attribute__((always_inline)) void place_solid(const StepConstants& c, const BodyArrays& b, double* rows,
                                                       long at, const SpatialBody<typename Lanes<W>::V>& body,
                                                       const Triple<typename Lanes<W>::V>& turning,
                                                       typename Lanes<W>::V& fastest) {
  using V = typename Lanes<W>::V;
  constexpr long length = 24;
  double* row = rows + length * at;
  const Triple<V> image = {load_as<V>(b.image[0] + at), load_as<V>(b.image[1] + at), load_as<V>(b.image[2] + at)};
  const Triple<V> shift = mapped(c.lattice, image), &x = body.position, &v = body.velocity;
  const V rolling = Lanes<W>::collected([=](int k) { return row[length * k + 3]; });
  const V lever = Lanes<W>::collected([=](int k) { return row[length * k + 23]; });
  const V places[4] = {x.x + shift.x, x.y + shift.y, x.z + shift.z, rolling}, velocities[4] = {v.x, v.y, v.z, V{}};
  const V spins[4] = {turning.x - c.spin[0], turning.y - c.spin[1], turning.z - c.spin[2], V{}};
  const V turns[4] = {body.turn.w, body.turn.v.x, body.turn.v.y, body.turn.v.z};
  rows_of<W>(places, row, length);
  rows_of<W>(velocities, row + 4, length);
  rows_of<W>(spins, row + 8, length);
  rows_of<W>(turns, row + 12, length);
  const V speed = square_root(dot(v, v)) + lever * square_root(dot(turning, turning));
  fastest = (speed > fastest) ? speed : fastest;
}

/// Spin and orientation after the step; returns the spin of the turn in the cell frame, rad/s.
template <bool AtRate, class V>
inline __attribute__((always_inline)) Triple<V> turn_body(const StepConstants& c, const BodyConstants& o,
                                                          const Triple<V>& torque, V inverse_inertia,
                                                          const Triple<V>& moments, const Triple<V>& inverse_moments,
                                                          const LaneAxes<V>& axes, SpatialBody<V>& body) {
  const V dt = V{} + c.dt, one = V{} + 1.0, half = V{} + 0.5;
  if constexpr (!AtRate) {
    body.spin = plus(body.spin, dt, times(inverse_inertia, torque));
    const Triple<V> turning = {body.spin.x + c.spin[0], body.spin.y + c.spin[1], body.spin.z + c.spin[2]};
    body.turn = normalised(turned_by(times(half * dt, turning), body.turn));
    return turning;
  }
  const Triple<V> spin = {body.spin.x + o.mean_spin_before[0], body.spin.y + o.mean_spin_before[1],
                          body.spin.z + o.mean_spin_before[2]};
  Triple<V> momentum = plus(by_axis(moments, to_body(axes, spin)), dt, to_body(axes, torque));
  const Triple<V> turned = rotate_freely(dt, inverse_moments, momentum);
  Triple<V> turn = times(half, to_cell(axes, turned));
  if (o.frame_turns) {
    const LaneTurn<V> back = {V{} + o.frame_back[0],
                              {V{} + o.frame_back[1], V{} + o.frame_back[2], V{} + o.frame_back[3]}};
    const LaneTurn<V> both = after(back, LaneTurn<V>{one, turn});
    turn = times(one / both.w, both.v);
  }
  body.turn = normalised(turned_by(turn, body.turn));
  const Triple<V> after_turn = to_cell(axes_of(body.turn), by_axis(inverse_moments, momentum));
  body.spin = {after_turn.x - o.mean_spin[0], after_turn.y - o.mean_spin[1], after_turn.z - o.mean_spin[2]};
  return times(V{} + 2.0 / c.dt, turn);
}

template <int W, bool Solid, bool AtRate>
inline __attribute__((always_inline)) void move_in_space(const StepConstants& c, const BodyConstants& o,
                                                         const BodyArrays& b, double* rows, long at, int part,
                                                         BodySums<W>& sums) {
  using V = typename Lanes<W>::V;
  constexpr long length = body_row_length;
  const V dt = V{} + c.dt, half_dt = V{} + 0.5 * c.dt, one = V{} + 1.0;
  double* row = b.motion + length * at;
  V x[4], u[4], s[4], q[4];
  columns_of<W>(row, length, x);
  columns_of<W>(row + 4, length, u);
  columns_of<W>(row + 8, length, s);
  columns_of<W>(row + 12, length, q);
  SpatialBody<V> body = {{x[0], x[1], x[2]},
                         {u[0] - c.mean_velocity[0], u[1] - c.mean_velocity[1], u[2] - c.mean_velocity[2]},
                         {s[0], s[1], s[2]},
                         {q[0], {q[1], q[2], q[3]}}};
  Triple<V>& v = body.velocity;
  Triple<V> force, torque;
  sum_in_space<W>(b, at, force, torque);
  const V inverse_mass = load_as<V>(b.inverse_mass + at);
  V inverse_inertia = {};
  Triple<V> moments = {}, inverse_moments = {};
  LaneAxes<V> axes = {};
  if constexpr (AtRate) {
    axes = axes_of(body.turn);
    moments = {load_as<V>(b.moments[0] + at), load_as<V>(b.moments[1] + at), load_as<V>(b.moments[2] + at)};
    inverse_moments = {load_as<V>(b.inverse_moments[0] + at), load_as<V>(b.inverse_moments[1] + at),
                       load_as<V>(b.inverse_moments[2] + at)};
    if (c.global_viscous != 0.0) {
      force = minus(force, V{} + c.global_viscous, v);
      if (c.losses) sums.lost_globally.add(part, c.dt * c.global_viscous * dot(v, v));
    }
  } else {
    inverse_inertia = load_as<V>(b.inverse_inertia + at);
  }
  if (o.damping != KernelDamping::none) {
    const Triple<V> ahead = plus(v, half_dt * inverse_mass, force), free_force = force, free_torque = torque;
    Triple<V> faster;
    if constexpr (AtRate)
      faster = to_cell(axes, by_axis(inverse_moments, to_body(axes, torque)));
    else
      faster = times(inverse_inertia, torque);
    const Triple<V> spin_ahead = plus(body.spin, half_dt, faster);
    force = damped(c, o.damping, force, ahead);
    torque = damped(c, o.damping, torque, spin_ahead);
    if (AtRate && c.losses)
      sums.lost_locally.add(
          part, c.dt * (dot(minus(free_force, one, force), ahead) + dot(minus(free_torque, one, torque), spin_ahead)));
  }
  const Triple<V> gained = times(dt, times(inverse_mass, force));
  if constexpr (AtRate)
    v = plus(mapped(c.momentum_map, v), one, mapped(c.force_map, gained));
  else
    v = plus(v, one, gained);
  const Triple<V> turning = turn_body<AtRate>(c, o, torque, inverse_inertia, moments, inverse_moments, axes, body);
  body.position = plus(mapped(c.map, body.position), one, mapped(c.velocity_map, v));
  const V mass = load_as<V>(b.mass + at);
  sums.momentum[0].add(part, mass * v.x);
  sums.momentum[1].add(part, mass * v.y);
  sums.momentum[2].add(part, mass * v.z);
  const V positions[4] = {body.position.x, body.position.y, body.position.z, V{}};
  const V velocities[4] = {v.x, v.y, v.z, V{}}, spins[4] = {body.spin.x, body.spin.y, body.spin.z, V{}};
  const V turns[4] = {body.turn.w, body.turn.v.x, body.turn.v.y, body.turn.v.z};
  rows_of<W>(positions, row, length);
  rows_of<W>(velocities, row + 4, length);
  rows_of<W>(spins, row + 8, length);
  rows_of<W>(turns, row + 12, length);
  if constexpr (Solid) {
    place_solid<W>(c, b, rows, at, body, turning, sums.fastest);
  } else {
    const V turnings[4] = {turning.x, turning.y, turning.z, V{}};
    rows_of<W>(turnings, b.turning + 4 * at, 4);
  }
}

template <int W, bool AtRate>
inline __attribute__((always_inline)) void move_in_plane(const StepConstants& c, const BodyConstants& o,
                                                         const BodyArrays& b, long at, int part, BodySums<W>& sums) {
  using V = typename Lanes<W>::V;
  constexpr long length = body_row_length;
  const V half_dt = V{} + 0.5 * c.dt;
  double* row = b.motion + length * at;
  V x[4], velocity[4], q[4], on_body[4];
  columns_of<W>(row, length, x);
  columns_of<W>(row + 4, length, velocity);
  columns_of<W>(row + 12, length, q);
  sum_in_plane<W>(b, at, on_body);
  V u = velocity[0] - c.mean_velocity[0], v = velocity[1] - c.mean_velocity[1];
  V w = Lanes<W>::collected([=](int k) { return row[length * k + 10]; });
  V fx = on_body[0], fy = on_body[1], torque = on_body[2];
  const V inverse_mass = load_as<V>(b.inverse_mass + at);
  const V inverse_inertia = load_as<V>((AtRate ? b.inverse_moments[2] : b.inverse_inertia) + at);
  if constexpr (AtRate)
    if (c.global_viscous != 0.0) {
      fx = fx - c.global_viscous * u;
      fy = fy - c.global_viscous * v;
      if (c.losses) sums.lost_globally.add(part, c.dt * c.global_viscous * (u * u + v * v));
    }
  if (o.damping != KernelDamping::none) {
    const V free_x = fx, free_y = fy, free_torque = torque, half_gain = half_dt * inverse_mass;
    const V px = u + half_gain * fx, py = v + half_gain * fy, pw = w + half_dt * (inverse_inertia * torque);
    if (o.damping == KernelDamping::vector) {
      const V factor = local_damping_factor(c.local_damping, fx * fx + fy * fy, px * px + py * py);
      fx = fx - factor * px;
      fy = fy - factor * py;
    } else {
      fx = damped_component(c.local_damping, fx, px);
      fy = damped_component(c.local_damping, fy, py);
    }
    torque = damped_component(c.local_damping, torque, pw);
    if (AtRate && c.losses)
      sums.lost_locally.add(part, c.dt * (((free_x - fx) * px + (free_y - fy) * py) + (free_torque - torque) * pw));
  }
  const V gained_u = c.dt * (inverse_mass * fx), gained_v = c.dt * (inverse_mass * fy);
  if constexpr (AtRate) {
    const double *P = c.momentum_map, *R = c.force_map;
    const V old_u = u, old_v = v;
    u = (P[0] * old_u + P[1] * old_v) + (R[0] * gained_u + R[1] * gained_v);
    v = (P[3] * old_u + P[4] * old_v) + (R[3] * gained_u + R[4] * gained_v);
    w = w + ((V{} + (o.mean_spin_before[2] - o.mean_spin[2])) + c.dt * (inverse_inertia * torque));
  } else {
    u = u + gained_u;
    v = v + gained_v;
    w = w + c.dt * (inverse_inertia * torque);
  }
  const V turning = w + c.spin[2], half = half_dt * turning, turn_w = q[0] - half * q[3], turn_z = q[3] + half * q[0];
  const V scale = 1.0 / square_root(turn_w * turn_w + turn_z * turn_z);
  const UpperTriangle &A = c.map, &B = c.velocity_map;
  const V positions[4] = {(A.xx * x[0] + A.xy * x[1]) + (B.xx * u + B.xy * v), A.yy * x[1] + B.yy * v, V{}, V{}};
  const V velocities[4] = {u, v, V{}, V{}}, spins[4] = {V{}, V{}, w, V{}};
  const V turns[4] = {scale * turn_w, q[1], q[2], scale * turn_z}, turnings[4] = {turning, V{}, V{}, V{}};
  rows_of<W>(positions, row, length);
  rows_of<W>(velocities, row + 4, length);
  rows_of<W>(spins, row + 8, length);
  rows_of<W>(turns, row + 12, length);
  rows_of<W>(turnings, b.turning + 4 * at, 4);
  const V mass = load_as<V>(b.mass + at);
  sums.momentum[0].add(part, mass * u);
  sums.momentum[1].add(part, mass * v);
}

/// `By`: the shape, like Disc.
template <class By, int W, bool AtRate>
void move_bodies(const StepConstants& constants, const BodyConstants& of_bodies, const BodyArrays& bodies, double* rows,
                 long begin, long end, StepSums* total) {
  const StepConstants c = constants;
  const BodyConstants o = of_bodies;
  const BodyArrays b = bodies;
  BodySums<W> sums;
  for (long eight = begin; eight < end; eight += 8)
#pragma GCC unroll 1
    for (int part = 0; part < 8 / W; ++part) {
      if constexpr (By::dimension == 2)
        move_in_plane<W, AtRate>(c, o, b, eight + part * W, part, sums);
      else
        move_in_space<W, !By::round, AtRate>(c, o, b, rows, eight + part * W, part, sums);
    }
  for (int k = 0; k < 3; ++k) total->momentum[k] = sums.momentum[k].total();
  const double fastest = largest_of(sums.fastest);
  total->largest_speed_squared = fastest * fastest;
  total->local_damping = sums.lost_locally.total();
  total->global_damping = sums.lost_globally.total();
}

}  // namespace
}  // namespace rvelab
