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

/// Sum of the force rows of superellipsoids, for gather_forces: on j force and torque, on i the force turned round and
/// the torque beside the pair.
template <int W, bool Rolling>
struct SolidRowSum {
  using L = Lanes<W>;
  typename L::Quad force, torque;
  const double* torque_rows;
  MomentSum<W, Rolling> moment;
  inline __attribute__((always_inline)) void begin(const PairArrays& p, std::uint16_t task) {
    torque_rows = (is_as_j(task) ? p.force : p.solid) + 4;
    force = torque = L::broadcast(0.0);
  }
  inline __attribute__((always_inline)) void add(const PairArrays& p, std::int32_t slot) {
    force = L::add(force, quad_at<W>(p.force + slot));
    torque = L::add(torque, quad_at<W>(torque_rows + slot));
    moment.add(p, slot);
  }
  inline __attribute__((always_inline)) void put(const GrainArrays&, long, std::uint16_t task, ChunkSums& to) {
    store_as(to.forces.of(task), force);
    store_as(to.torques.of(task), moment.added_to(torque, task));
  }
};
template <int W>
inline __attribute__((always_inline)) void gather_solids(const GrainArrays& g, const PairArrays& p, long first,
                                                         long count, ChunkSums& sums) {
  constexpr int narrow = W < 4 ? W : 4;
  if (g.rolling)
    gather_forces<SolidRowSum<narrow, true>>(g, p, first, count, sums);
  else
    gather_forces<SolidRowSum<narrow, false>>(g, p, first, count, sums);
}

/// Of a chunk in space: rows of eight, {f, -, T, -}, about the centre of the body.
template <int W, bool Solid>
inline __attribute__((always_inline)) void put_resultants_in_space(const BodyArrays& b, long first, long count,
                                                                   const ChunkSums& sums) {
  using L = Lanes<W>;
  using V = typename L::V;
  constexpr int length = force_row_length(3);
  for (long k = 0; k < count; k += W) {
    const long at = first + k;
    if constexpr (Solid) {
      for (int lane = 0; lane < W; ++lane) {
        store_as(b.resultants + length * (at + lane), force_in_space<W>(sums, k + lane));
        store_as(b.resultants + length * (at + lane) + 4, torque_in_space<W>(sums, k + lane));
      }
      continue;
    }
    typename L::Quad quads[W];
    V f[4], t[4];
    for (int lane = 0; lane < W; ++lane) quads[lane] = force_in_space<W>(sums, k + lane);
    L::transpose(quads, f);
    for (int lane = 0; lane < W; ++lane) quads[lane] = torque_in_space<W>(sums, k + lane);
    L::transpose(quads, t);
    const Triple<V> turning = cross(load_vec<V>(b.arm, at), first_of<3>(f));
    rows_of<W>(f, b.resultants + length * at, length);
    rows_of<W>(first_of<3>(t) + turning, V{}, b.resultants + length * at + 4, length);
  }
}

/// Of a chunk in the plane: rows of four, {fx, fy, T, -}.
template <int W>
inline __attribute__((always_inline)) void put_resultants_in_plane(const BodyArrays& b, long first, long count,
                                                                   const ChunkSums& sums) {
  using L = Lanes<W>;
  using V = typename L::V;
  constexpr int length = force_row_length(2);
  for (long k = 0; k < count; k += W) {
    const long at = first + k;
    typename L::Quad net[W];
    for (int lane = 0; lane < W; ++lane) net[lane] = resultant_in_plane<W>(sums, k + lane);
    V a[4];
    L::transpose(net, a);
    const Vec<V, 2> arm = load_vec<V, 2>(b.arm, at);
    const V row[4] = {a[0], a[1], a[2] + (arm.x * a[1] - arm.y * a[0]), V{}};
    rows_of<W>(row, b.resultants + length * at, length);
  }
}

/// `By`: the shape, like Disc.
template <class By, int W>
void gather_on_members(const GrainArrays& grains, const PairArrays& pairs, const BodyArrays& bodies, long begin,
                       long end) {
  const BodyArrays b = bodies;
  ChunkSums sums;
  for (long chunk = begin; chunk < end; chunk += chunk_grains) {
    const long count = end - chunk < chunk_grains ? end - chunk : chunk_grains;
    if constexpr (By::dimension == 2) {
      gather_in_plane<W>(grains, pairs, chunk, count, sums);
      put_resultants_in_plane<W>(b, chunk, count, sums);
    } else {
      if constexpr (By::round)
        gather_spheres<W>(grains, pairs, chunk, count, sums);
      else
        gather_solids<W>(grains, pairs, chunk, count, sums);
      put_resultants_in_space<W, !By::round>(b, chunk, count, sums);
    }
  }
}

/// Spheres.
template <int W>
inline __attribute__((always_inline)) typename Lanes<W>::V place_in_space(const StepConstants& c,
                                                                          const BodyConstants& o, const BodyArrays& b,
                                                                          double* rows, long at) {
  using V = typename Lanes<W>::V;
  constexpr int length = body_row_length;
  const std::int32_t* body = b.row_of_owner + at;
  V x[4], u[4], q[4], w[4];
  ColumnsOf<W>::load([=](int k) { return b.motion + body[k]; }, x);
  ColumnsOf<W>::load([=](int k) { return b.motion + body[k] + 4; }, u);
  ColumnsOf<W>::load([=](int k) { return b.motion + body[k] + 12; }, q);
  ColumnsOf<W>::load([=](int k) { return b.turning + body[k] / (length / 4); }, w);
  const Triple<V> from = load_vec<V>(b.arm, at);
  const Triple<V> arm = to_cell(axes_of(LaneTurn<V>{q[0], {q[1], q[2], q[3]}}), load_vec<V>(b.offset, at));
  store_vec(b.arm, at, arm);
  const Triple<V> spin = first_of<3>(w), middle = times(0.5, from + arm);
  const Triple<V> by_turn = mapped(o.inverse_stretch, cross(spin, middle)), by_strain = mapped(o.gradient, from);
  const Triple<V> v = (first_of<3>(u) + by_turn) - by_strain;
  double* row = rows + 12 * at;
  const V radius = Lanes<W>::collected([=](int k) { return row[12 * k + 3]; });
  rows_of<W>(branch_with_image(c.lattice, first_of<3>(x) + arm, load_vec<V>(b.image, at)), radius, row, 12);
  rows_of<W>(v, V{}, row + 4, 12);
  rows_of<W>(without_cell_spin(c, spin), radius, row + 8, 12);
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
  const Vec<V, 2> offset = load_vec<V, 2>(b.offset, at), from = load_vec<V, 2>(b.arm, at);
  const Vec<V, 2> arm = {cosine * offset.x - sine * offset.y, sine * offset.x + cosine * offset.y};
  store_vec(b.arm, at, arm);
  const Vec<V, 2> middle = times(0.5, from + arm), turned = {-w * middle.y, w * middle.x};
  const Vec<V, 2> v = (first_of<2>(u) + mapped(o.inverse_stretch, turned)) - mapped(o.gradient, from);
  const Vec<V, 2> position = branch_with_image(c.lattice, first_of<2>(x) + arm, load_vec<V, 2>(b.image, at));
  double* row = rows + 8 * at;
  const V places[4] = {position.x, position.y, v.x, v.y};
  const V spins[4] = {w - c.spin[2], V{}, V{}, V{}};
  rows_of<W>(places, row, 8);
  rows_of<W>(spins, row + 4, 8);
  return dot(v, v);
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
