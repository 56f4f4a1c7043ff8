// Members of bodies: forces gathered on them before the bodies move (bodies.hpp), and their places after.
//
//   T_body = T + a x f                        a the arm, from the centre of the body to that of the member
//   x_g  = c + R o_g + L n_g
//   v'_g = v' + B^-1 (w x o) - G o0           (loading/body_motion.hpp)
#pragma once

#include "rvelab/grains/turns.hpp"
#include "rvelab/solver/kernels/integrate_discs.hpp"
#include "rvelab/solver/kernels/integrate_spheres.hpp"

namespace rvelab {
namespace {

/// Force rows of superellipsoids: on j force and torque, on i the force turned round and the torque beside the pair.
template <int W, bool Rolling>
inline __attribute__((always_inline)) void gather_solid_forces(const GrainArrays& g, const PairArrays& p, long first,
                                                               long count, TaskRows& forces, TaskRows& torques) {
  constexpr int narrow = W < 4 ? W : 4;
  using L = Lanes<narrow>;
  using Quad = typename L::Quad;
  const std::int32_t* slot = g.slots + 4L * g.slot_begin[first / 2];
  for (long block = first / 2; block < (first + count) / 2; ++block) {
    const std::int32_t* last = g.slots + 4L * g.slot_begin[block + 1];
    const double* torque_rows[4];
    Quad force[4], torque[4];
    for (int k = 0; k < 4; ++k) {
      torque_rows[k] = (g.tasks[4 * block + k] < 4 * chunk_grains ? p.force : p.solid) + 4;
      force[k] = torque[k] = L::broadcast(0.0);
    }
    double moment[4][4] = {};
    for (; slot != last; slot += 4)
#pragma GCC unroll 4
      for (int k = 0; k < 4; ++k) {
        force[k] = L::add(force[k], quad_at<narrow>(p.force + slot[k]));
        torque[k] = L::add(torque[k], quad_at<narrow>(torque_rows[k] + slot[k]));
        if constexpr (Rolling)
          for (int m = 0; m < 3; ++m) moment[k][m] += p.moment[m][slot[k] / 8];
      }
#pragma GCC unroll 4
    for (int k = 0; k < 4; ++k) {
      const std::uint16_t task = g.tasks[4 * block + k];
      if constexpr (Rolling)
        torque[k] =
            L::add(torque[k], L::mul(L::broadcast(task < 4 * chunk_grains ? 1.0 : -1.0), quad_at<narrow>(moment[k])));
      store_as(forces.of(task), force[k]);
      store_as(torques.of(task), torque[k]);
    }
  }
}

/// Of a chunk in space: rows of eight, {f, -, T, -}, about the centre of the body.
template <int W, bool Solid>
inline __attribute__((always_inline)) void put_resultants_in_space(const BodyArrays& b, long first, long count,
                                                                   const TaskRows& forces, const TaskRows& torques) {
  using L = Lanes<W>;
  using V = typename L::V;
  for (long k = 0; k < count; k += W) {
    const long at = first + k;
    typename L::Quad quads[W];
    V f[4], t[4];
    for (int lane = 0; lane < W; ++lane)
      quads[lane] = L::sub(quad_at<W>(forces.as_j(k + lane)), quad_at<W>(forces.as_i(k + lane)));
    if constexpr (Solid)
      for (int lane = 0; lane < W; ++lane) store_as(b.resultants + 8 * (at + lane), quads[lane]);
    else
      L::transpose(quads, f);
    for (int lane = 0; lane < W; ++lane)
      quads[lane] = L::add(quad_at<W>(torques.as_j(k + lane)), quad_at<W>(torques.as_i(k + lane)));
    if constexpr (Solid) {
      for (int lane = 0; lane < W; ++lane) store_as(b.resultants + 8 * (at + lane) + 4, quads[lane]);
      continue;
    }
    L::transpose(quads, t);
    const Triple<V> arm = {load_as<V>(b.arm[0] + at), load_as<V>(b.arm[1] + at), load_as<V>(b.arm[2] + at)};
    const Triple<V> turning = cross(arm, Triple<V>{f[0], f[1], f[2]});
    const V torque[4] = {t[0] + turning.x, t[1] + turning.y, t[2] + turning.z, V{}};
    rows_of<W>(f, b.resultants + 8 * at, 8);
    rows_of<W>(torque, b.resultants + 8 * at + 4, 8);
  }
}

/// Of a chunk in the plane: rows of four, {fx, fy, T, -}.
template <int W>
inline __attribute__((always_inline)) void put_resultants_in_plane(const BodyArrays& b, long first, long count,
                                                                   const TaskRows& sums) {
  using L = Lanes<W>;
  using V = typename L::V;
  for (long k = 0; k < count; k += W) {
    const long at = first + k;
    typename L::Quad net[W];
    for (int lane = 0; lane < W; ++lane)
      net[lane] = L::add(quad_at<W>(sums.as_j(k + lane)), L::seen_from_i(quad_at<W>(sums.as_i(k + lane))));
    V a[4];
    L::transpose(net, a);
    const V arm_x = load_as<V>(b.arm[0] + at), arm_y = load_as<V>(b.arm[1] + at);
    const V row[4] = {a[0], a[1], a[2] + (arm_x * a[1] - arm_y * a[0]), V{}};
    rows_of<W>(row, b.resultants + 4 * at, 4);
  }
}

/// `By`: the shape, like Disc.
template <class By, int W, bool Rolling>
void gather_on_members(const GrainArrays& grains, const PairArrays& pairs, const BodyArrays& bodies, long begin,
                       long end) {
  const GrainArrays g = grains;
  const PairArrays p = pairs;
  const BodyArrays b = bodies;
  TaskRows forces;
  [[maybe_unused]] TaskRows torques;
  for (long chunk = begin; chunk < end; chunk += chunk_grains) {
    const long count = end - chunk < chunk_grains ? end - chunk : chunk_grains;
    if constexpr (By::dimension == 2) {
      gather_disc_forces<W>(g, p, chunk, count, forces);
      put_resultants_in_plane<W>(b, chunk, count, forces);
    } else {
      if constexpr (By::round)
        gather_sphere_forces<W, Rolling>(g, p, chunk, count, forces, torques);
      else
        gather_solid_forces<W, Rolling>(g, p, chunk, count, forces, torques);
      put_resultants_in_space<W, !By::round>(b, chunk, count, forces, torques);
    }
  }
}

/// An upper triangular matrix times a vector.
template <class V>
inline __attribute__((always_inline)) Triple<V> mapped(const UpperTriangle& m, const Triple<V>& a) {
  return {m.xx * a.x + (m.xy * a.y + m.xz * a.z), m.yy * a.y + m.yz * a.z, m.zz * a.z};
}

/// Spheres.
template <int W>
inline __attribute__((always_inline)) typename Lanes<W>::V place_in_space(const StepConstants& c,
                                                                          const BodyConstants& o, const BodyArrays& b,
                                                                          double* rows, long at) {
  using V = typename Lanes<W>::V;
  constexpr int length = body_row_length;
  const V one = V{} + 1.0;
  const std::int32_t* body = b.row_of_owner + at;
  V x[4], u[4], q[4], w[4];
  ColumnsOf<W>::load([=](int k) { return b.motion + body[k]; }, x);
  ColumnsOf<W>::load([=](int k) { return b.motion + body[k] + 4; }, u);
  ColumnsOf<W>::load([=](int k) { return b.motion + body[k] + 12; }, q);
  ColumnsOf<W>::load([=](int k) { return b.turning + body[k] / (length / 4); }, w);
  const Triple<V> offset = {load_as<V>(b.offset[0] + at), load_as<V>(b.offset[1] + at), load_as<V>(b.offset[2] + at)};
  const Triple<V> image = {load_as<V>(b.image[0] + at), load_as<V>(b.image[1] + at), load_as<V>(b.image[2] + at)};
  const Triple<V> from = load_triple<V>(b.arm, at);
  const Triple<V> arm = to_cell(axes_of(LaneTurn<V>{q[0], {q[1], q[2], q[3]}}), offset);
  store_triple(b.arm, at, arm);
  const Triple<V> middle = times(V{} + 0.5, plus(from, one, arm));
  const Triple<V> by_turn = mapped(o.inverse_stretch, cross(Triple<V>{w[0], w[1], w[2]}, middle));
  const Triple<V> by_strain = mapped(o.gradient, from), shift = mapped(c.lattice, image);
  const Triple<V> v = {(u[0] + by_turn.x) - by_strain.x, (u[1] + by_turn.y) - by_strain.y,
                       (u[2] + by_turn.z) - by_strain.z};
  double* row = rows + 12 * at;
  const V radius = Lanes<W>::collected([=](int k) { return row[12 * k + 3]; });
  const V places[4] = {(x[0] + arm.x) + shift.x, (x[1] + arm.y) + shift.y, (x[2] + arm.z) + shift.z, radius};
  const V velocities[4] = {v.x, v.y, v.z, V{}};
  const V spins[4] = {w[0] - c.spin[0], w[1] - c.spin[1], w[2] - c.spin[2], radius};
  rows_of<W>(places, row, 12);
  rows_of<W>(velocities, row + 4, 12);
  rows_of<W>(spins, row + 8, 12);
  return dot(v, v);
}

/// Discs.
template <int W>
inline __attribute__((always_inline)) typename Lanes<W>::V place_in_plane(const StepConstants& c,
                                                                          const BodyConstants& o, const BodyArrays& b,
                                                                          double* rows, long at) {
  using V = typename Lanes<W>::V;
  constexpr int length = body_row_length;
  const V one = V{} + 1.0, two = V{} + 2.0;
  const std::int32_t* body = b.row_of_owner + at;
  const double *motion = b.motion, *turning = b.turning;
  V x[4], u[4], q[4];
  ColumnsOf<W>::load([=](int k) { return motion + body[k]; }, x);
  ColumnsOf<W>::load([=](int k) { return motion + body[k] + 4; }, u);
  ColumnsOf<W>::load([=](int k) { return motion + body[k] + 12; }, q);
  const V w = Lanes<W>::collected([=](int k) { return turning[body[k] / (length / 4)]; });
  const V cosine = one - two * (q[3] * q[3]), sine = two * (q[0] * q[3]);
  const V ox = load_as<V>(b.offset[0] + at), oy = load_as<V>(b.offset[1] + at);
  const V from_x = load_as<V>(b.arm[0] + at), from_y = load_as<V>(b.arm[1] + at);
  const V arm_x = cosine * ox - sine * oy, arm_y = sine * ox + cosine * oy;
  store_as(b.arm[0] + at, arm_x);
  store_as(b.arm[1] + at, arm_y);
  const V turn_x = -w * (0.5 * (from_y + arm_y)), turn_y = w * (0.5 * (from_x + arm_x));
  const UpperTriangle &B = o.inverse_stretch, &G = o.gradient, &L = c.lattice;
  const V vx = (u[0] + (B.xx * turn_x + B.xy * turn_y)) - (G.xx * from_x + G.xy * from_y);
  const V vy = (u[1] + B.yy * turn_y) - G.yy * from_y;
  const V nx = load_as<V>(b.image[0] + at), ny = load_as<V>(b.image[1] + at);
  double* row = rows + 8 * at;
  const V places[4] = {(x[0] + arm_x) + (L.xx * nx + L.xy * ny), (x[1] + arm_y) + L.yy * ny, vx, vy};
  const V spins[4] = {w - c.spin[2], V{}, V{}, V{}};
  rows_of<W>(places, row, 8);
  rows_of<W>(spins, row + 4, 8);
  return vx * vx + vy * vy;
}

template <int W, int dimension>
void place_members(const StepConstants& constants, const BodyConstants& of_bodies, const BodyArrays& bodies,
                   double* rows, long begin, long end, StepSums* sums) {
  const StepConstants c = constants;
  const BodyConstants o = of_bodies;
  const BodyArrays b = bodies;
  typename Lanes<W>::V fastest = {};
  for (long at = begin; at < end; at += W) {
    typename Lanes<W>::V squared;
    if constexpr (dimension == 2)
      squared = place_in_plane<W>(c, o, b, rows, at);
    else
      squared = place_in_space<W>(c, o, b, rows, at);
    fastest = (squared > fastest) ? squared : fastest;
  }
  sums->largest_speed_squared = largest_of(fastest);
}

}  // namespace
}  // namespace rvelab
