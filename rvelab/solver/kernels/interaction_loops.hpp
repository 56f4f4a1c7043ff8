// The loops over interactions other than contacts: geometry and motion of W pairs, the law, the force rows. Slip and
// arms are those of consistent contacts (contact/README.md): the point halves the gap, so that work and moments
// balance.
#pragma once

#include "rvelab/interaction/laws.hpp"
#include "rvelab/solver/kernels/pairs.hpp"

namespace rvelab {
namespace {

/// Branch of pairs; unlike those of contacts nearly all that matter are near, and no block is without a look at images.
template <class V>
inline __attribute__((always_inline)) Triple<V> interaction_branch(const StepConstants& c, const InteractionArrays& p,
                                                                   long at, const Triple<V>& d) {
  const V image_x = load_as<V>(p.image[0] + at), image_y = load_as<V>(p.image[1] + at);
  const V image_z = load_as<V>(p.image[2] + at);
  return {d.x + (c.lattice.xx * image_x + (c.lattice.xy * image_y + c.lattice.xz * image_z)),
          d.y + (c.lattice.yy * image_y + c.lattice.yz * image_z), d.z + c.lattice.zz * image_z};
}

template <class Law, int W, bool Advance>
void plane_interactions(const StepConstants& constants, const InteractionArrays& arrays, const double* rows, long begin,
                        long end) {
  using V = typename Lanes<W>::V;
  const StepConstants c = constants;
  const InteractionArrays p = arrays;
  const double half_dt = 0.5 * c.dt;
  for (long at = begin; at < end; at += W) {
    V d[4];
    gather_differences<W>(rows, p.row_i + at, p.row_j + at, d);
    const V image_x = load_as<V>(p.image[0] + at), image_y = load_as<V>(p.image[1] + at);
    const V bx = d[0] + (c.lattice.xx * image_x + c.lattice.xy * image_y), by = d[1] + c.lattice.yy * image_y;
    PlaneMotion<V> m;
    m.length = square_root(bx * bx + by * by);
    const V nx = bx / m.length, ny = by / m.length;
    const V radius_i = load_as<V>(p.radius_i + at), radius_j = load_as<V>(p.radius_j + at);
    const V half_gap = 0.5 * (m.length - (radius_i + radius_j));
    const V arm_i = radius_i + half_gap, arm_j = radius_j + half_gap;
    if constexpr (Advance) {
      const V spin_i = gather_spins<W>(rows, p.row_i + at), spin_j = gather_spins<W>(rows, p.row_j + at);
      const V px = bx - half_dt * d[2], py = by - half_dt * d[3];
      const V vx = d[2] + (c.rate.xx * px + c.rate.xy * py), vy = d[3] + c.rate.yy * py;
      m.slip = c.dt * ((nx * vy - ny * vx) - ((arm_j * spin_j + arm_i * spin_i) + c.spin[2] * m.length));
      m.turn = c.dt * (spin_j - spin_i);
    }
    const PlaneForces<V> f = Law::template in_plane<Advance, V>(p, at, m);
    const V columns[4] = {nx * f.normal - ny * f.tangential, ny * f.normal + nx * f.tangential,
                          f.moment - arm_j * f.tangential, (V{} - f.moment) - arm_i * f.tangential};
    rows_of<W>(columns, p.force + 4 * at, 4);
  }
}

template <class Law, int W, bool Advance>
void space_interactions(const StepConstants& constants, const InteractionArrays& arrays, const double* rows, long begin,
                        long end) {
  using V = typename Lanes<W>::V;
  const StepConstants c = constants;
  const InteractionArrays p = arrays;
  const double half_dt = 0.5 * c.dt;
  const V zero = V{}, one = zero + 1.0;
  for (long at = begin; at < end; at += W) {
    const std::int32_t *i = p.row_i + at, *j = p.row_j + at;
    V d[4];
    gather_differences<W>(rows, i, j, d);
    const Triple<V> b = interaction_branch<V>(c, p, at, {d[0], d[1], d[2]});
    SpaceTurn<V> m;
    m.length = square_root(dot(b, b));
    m.n = times(one / m.length, b);
    const V radius_i = load_as<V>(p.radius_i + at), radius_j = load_as<V>(p.radius_j + at);
    const V half_gap = 0.5 * (m.length - (radius_i + radius_j));
    const V arm_i = radius_i + half_gap, arm_j = radius_j + half_gap;
    if constexpr (Advance) {
      V u[4], si[4], sj[4];
      gather_differences<W>(rows + 4, i, j, u);
      ColumnsOf<W>::load([=](int lane) { return rows + i[lane] + 8; }, si);
      ColumnsOf<W>::load([=](int lane) { return rows + j[lane] + 8; }, sj);
      const Triple<V> px = plus(b, zero - half_dt, {u[0], u[1], u[2]});
      const Triple<V> v = {u[0] + (c.rate.xx * px.x + (c.rate.xy * px.y + c.rate.xz * px.z)),
                           u[1] + (c.rate.yy * px.y + c.rate.yz * px.z), u[2] + c.rate.zz * px.z};
      const Triple<V> arms = {(arm_j * sj[0] + arm_i * si[0]) + c.spin[0] * m.length,
                              (arm_j * sj[1] + arm_i * si[1]) + c.spin[1] * m.length,
                              (arm_j * sj[2] + arm_i * si[2]) + c.spin[2] * m.length};
      const Triple<V> along = plus(v, zero - dot(m.n, v), m.n);
      m.slip = times(zero + c.dt, plus(along, zero - one, cross(arms, m.n)));
      m.turn = times(zero + c.dt, Triple<V>{sj[0] - si[0], sj[1] - si[1], sj[2] - si[2]});
      m.twist = (0.5 * c.dt) * dot(m.n, Triple<V>{(si[0] + sj[0]) + 2.0 * c.spin[0], (si[1] + sj[1]) + 2.0 * c.spin[1],
                                                  (si[2] + sj[2]) + 2.0 * c.spin[2]});
    }
    const SpaceForces<V> f = Law::template in_space<Advance, V>(p, at, m);
    const Triple<V> force = plus(f.tangential, f.normal, m.n), turning = cross(m.n, f.tangential);
    const Triple<V> torque_j = plus(f.moment, zero - arm_j, turning),
                    torque_i = plus(times(zero - one, f.moment), zero - arm_i, turning);
    const auto write = [&](const Triple<V>& torque, V radius, double* to) {
      const V over = one / ((radius > 0.0) ? radius : one);
      const V first_half[4] = {force.x, force.y, force.z, 2.0 * radius};
      const V second_half[4] = {torque.x * over, torque.y * over, torque.z * over, zero};
      rows_of<W>(first_half, to, 16);
      rows_of<W>(second_half, to + 4, 16);
    };
    write(torque_j, radius_j, p.force + 16 * at);
    write(torque_i, radius_i, p.force + 16 * at + 8);
  }
}

}  // namespace
}  // namespace rvelab
