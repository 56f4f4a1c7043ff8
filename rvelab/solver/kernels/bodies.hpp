// The loop over bodies, W at a time: damping, velocity, spin, orientation, place (loading/body_motion.hpp). Forces have
// been gathered on their members before, and these are placed after (body_members.hpp); a superellipsoid is placed
// here.
//
// At a rate the body turns freely by the Cayley rotation of t wm, R t wm in the cell frame; where the frame turns, the
// quaternion of its way back is put before. The spin of the whole turn is the Cayley vector of both over dt.
#pragma once

#include "rvelab/solver/kernels/body_members.hpp"

namespace rvelab {
namespace {

/// Sums over the members of W bodies, to columns.
template <int W>
inline __attribute__((always_inline)) void sum_in_space(const BodyArrays& b, long at,
                                                        Triple<typename Lanes<W>::V>& force,
                                                        Triple<typename Lanes<W>::V>& torque) {
  constexpr int length = force_row_length(3);
  typename Lanes<W>::Quad forces[W], torques[W];
  for (int lane = 0; lane < W; ++lane) {
    RowSum<W> sum;
    const double* last = b.resultants + long(length) * b.first[at + lane + 1];
    for (const double* row = b.resultants + long(length) * b.first[at + lane]; row != last; row += length) sum.add(row);
    forces[lane] = sum.first_half();
    torques[lane] = sum.second_half();
  }
  typename Lanes<W>::V column[4];
  Lanes<W>::transpose(forces, column);
  force = first_of<3>(column);
  Lanes<W>::transpose(torques, column);
  torque = first_of<3>(column);
}
template <int W>
inline __attribute__((always_inline)) void sum_in_plane(const BodyArrays& b, long at, typename Lanes<W>::V* column) {
  using L = Lanes<W>;
  constexpr int length = force_row_length(2);
  typename L::Quad sums[W];
  for (int lane = 0; lane < W; ++lane) {
    sums[lane] = L::broadcast(0.0);
    const double* last = b.resultants + long(length) * b.first[at + lane + 1];
    for (const double* row = b.resultants + long(length) * b.first[at + lane]; row != last; row += length)
      sums[lane] = L::add(sums[lane], quad_at<W>(row));
  }
  L::transpose(sums, column);
}

/// Cundall's damping of W forces, or torques, by the velocity or spin half a step ahead. In the plane a torque has one
/// component, and both forms are one.
template <class V>
inline __attribute__((always_inline)) V damped(const StepConstants& c, KernelDamping, V torque, V ahead) {
  return damped_by_component(c, torque, ahead);
}
template <class V, int D>
inline __attribute__((always_inline)) Vec<V, D> damped(const StepConstants& c, KernelDamping damping,
                                                       const Vec<V, D>& force, const Vec<V, D>& ahead) {
  if (damping == KernelDamping::vector) return minus(force, damping_factor(c, force, ahead), ahead);
  return damped_by_component(c, force, ahead);
}
/// Of force and torque; `faster`: what the torque adds to the spin in a second.
template <bool AtRate, int W, class V, int D, class Spin>
inline __attribute__((always_inline)) void damp_body(const StepConstants& c, const BodyConstants& o, V inverse_mass,
                                                     const Vec<V, D>& v, const Spin& spin, const Spin& faster,
                                                     Vec<V, D>& force, Spin& torque, int part, PartialSums<W>& lost) {
  const V half_dt = V{} + 0.5 * c.dt;
  const Vec<V, D> ahead = plus(v, half_dt * inverse_mass, force), free = force;
  const Spin spin_ahead = plus(spin, half_dt, faster), free_torque = torque;
  force = damped(c, o.damping, force, ahead);
  torque = damped(c, o.damping, torque, spin_ahead);
  if constexpr (AtRate) book_local_damping(c, free - force, ahead, free_torque - torque, spin_ahead, part, lost);
}

template <class V>
struct SpatialBody {
  Triple<V> position, velocity, spin;
  LaneTurn<V> turn;
};

template <int W>
inline __attribute__((always_inline)) void put_turn(const LaneTurn<typename Lanes<W>::V>& turn, double* row,
                                                    long stride) {
  const typename Lanes<W>::V columns[4] = {turn.w, turn.v.x, turn.v.y, turn.v.z};
  rows_of<W>(columns, row, stride);
}

/// Row of a superellipsoid; its surface comes nearer by its turn too (assembly/oriented_bounds.hpp).
template <int W>
inline __attribute__((always_inline)) void place_solid(const StepConstants& c, const BodyArrays& b, double* rows,
                                                       long at, const SpatialBody<typename Lanes<W>::V>& body,
                                                       const Triple<typename Lanes<W>::V>& turning, LaneSums<W>& sums) {
  using V = typename Lanes<W>::V;
  constexpr long length = 24;
  double* row = rows + length * at;
  const Triple<V>& v = body.velocity;
  const V rolling = Lanes<W>::collected([=](int k) { return row[length * k + 3]; });
  const V lever = Lanes<W>::collected([=](int k) { return row[length * k + 23]; });
  rows_of<W>(branch_with_image(c.lattice, body.position, load_vec<V>(b.image, at)), rolling, row, length);
  rows_of<W>(v, V{}, row + 4, length);
  rows_of<W>(without_cell_spin(c, turning), V{}, row + 8, length);
  put_turn<W>(body.turn, row + 12, length);
  sums.see_speed(square_root(dot(v, v)) + lever * square_root(dot(turning, turning)));
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
    const Triple<V> turning = with_cell_spin(c, body.spin, 1.0);
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
inline __attribute__((always_inline)) void move_body_in_space(const StepConstants& c, const BodyConstants& o,
                                                              const BodyArrays& b, double* rows, long at, int part,
                                                              LaneSums<W>& sums) {
  using V = typename Lanes<W>::V;
  constexpr long length = body_row_length;
  double* row = b.motion + length * at;
  V q[4];
  columns_of<W>(row + 12, length, q);
  const Triple<V> mean = {V{} + c.mean_velocity[0], V{} + c.mean_velocity[1], V{} + c.mean_velocity[2]};
  SpatialBody<V> body = {triple_of<W>(row, length),
                         triple_of<W>(row + 4, length) - mean,
                         triple_of<W>(row + 8, length),
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
    moments = load_vec<V>(b.moments, at);
    inverse_moments = load_vec<V>(b.inverse_moments, at);
    damp_globally(c, v, force, part, sums.lost_globally);
  } else {
    inverse_inertia = load_as<V>(b.inverse_inertia + at);
  }
  if (o.damping != KernelDamping::none) {
    Triple<V> faster;
    if constexpr (AtRate)
      faster = to_cell(axes, by_axis(inverse_moments, to_body(axes, torque)));
    else
      faster = times(inverse_inertia, torque);
    damp_body<AtRate>(c, o, inverse_mass, v, body.spin, faster, force, torque, part, sums.lost_locally);
  }
  v = next_velocity<AtRate>(c, v, times(c.dt, times(inverse_mass, force)));
  const Triple<V> turning = turn_body<AtRate>(c, o, torque, inverse_inertia, moments, inverse_moments, axes, body);
  body.position = next_position(c, body.position, v);
  sums.add_momentum(part, load_as<V>(b.mass + at), v);
  rows_of<W>(body.position, V{}, row, length);
  rows_of<W>(v, V{}, row + 4, length);
  rows_of<W>(body.spin, V{}, row + 8, length);
  put_turn<W>(body.turn, row + 12, length);
  if constexpr (Solid)
    place_solid<W>(c, b, rows, at, body, turning, sums);
  else
    rows_of<W>(turning, V{}, b.turning + 4 * at, 4);
}

template <int W, bool AtRate>
inline __attribute__((always_inline)) void move_body_in_plane(const StepConstants& c, const BodyConstants& o,
                                                              const BodyArrays& b, long at, int part,
                                                              LaneSums<W>& sums) {
  using V = typename Lanes<W>::V;
  constexpr long length = body_row_length;
  double* row = b.motion + length * at;
  V x[4], u[4], q[4], on_body[4];
  columns_of<W>(row, length, x);
  columns_of<W>(row + 4, length, u);
  columns_of<W>(row + 12, length, q);
  sum_in_plane<W>(b, at, on_body);
  Vec<V, 2> v = {u[0] - c.mean_velocity[0], u[1] - c.mean_velocity[1]}, force = first_of<2>(on_body);
  V w = Lanes<W>::collected([=](int k) { return row[length * k + 10]; }), torque = on_body[2];
  const V inverse_mass = load_as<V>(b.inverse_mass + at);
  const V inverse_inertia = load_as<V>((AtRate ? b.inverse_moments[2] : b.inverse_inertia) + at);
  if constexpr (AtRate) damp_globally(c, v, force, part, sums.lost_globally);
  if (o.damping != KernelDamping::none)
    damp_body<AtRate>(c, o, inverse_mass, v, w, inverse_inertia * torque, force, torque, part, sums.lost_locally);
  v = next_velocity<AtRate>(c, v, times(c.dt, times(inverse_mass, force)));
  const V gained = c.dt * (inverse_inertia * torque);
  if constexpr (AtRate)
    w = w + ((V{} + (o.mean_spin_before[2] - o.mean_spin[2])) + gained);
  else
    w = w + gained;
  const V turning = w + c.spin[2], half = (0.5 * c.dt) * turning;
  const V turn_w = q[0] - half * q[3], turn_z = q[3] + half * q[0];
  const V scale = 1.0 / square_root(turn_w * turn_w + turn_z * turn_z);
  const Vec<V, 2> to = next_position(c, first_of<2>(x), v);
  const V turns[4] = {scale * turn_w, q[1], q[2], scale * turn_z};
  rows_of<W>(Triple<V>{to.x, to.y, V{}}, V{}, row, length);
  rows_of<W>(Triple<V>{v.x, v.y, V{}}, V{}, row + 4, length);
  rows_of<W>(Triple<V>{V{}, V{}, w}, V{}, row + 8, length);
  rows_of<W>(turns, row + 12, length);
  rows_of<W>(Triple<V>{turning, V{}, V{}}, V{}, b.turning + 4 * at, 4);
  sums.add_momentum(part, load_as<V>(b.mass + at), v);
}

/// `By`: the shape, like Disc.
template <class By, int W, bool AtRate>
void move_bodies(const StepConstants& constants, const BodyConstants& of_bodies, const BodyArrays& bodies, double* rows,
                 long begin, long end, StepSums* total) {
  const StepConstants c = constants;
  const BodyConstants o = of_bodies;
  const BodyArrays b = bodies;
  LaneSums<W> sums;
  for (long eight = begin; eight < end; eight += 8)
#pragma GCC unroll 1
    for (int part = 0; part < 8 / W; ++part) {
      if constexpr (By::dimension == 2)
        move_body_in_plane<W, AtRate>(c, o, b, eight + part * W, part, sums);
      else
        move_body_in_space<W, !By::round, AtRate>(c, o, b, rows, eight + part * W, part, sums);
    }
  sums.put(total);
  total->largest_speed_squared *= total->largest_speed_squared;
}

}  // namespace
}  // namespace rvelab
