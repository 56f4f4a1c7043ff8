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

/// Where the vector fields of a law begin among its columns.
template <class Law>
constexpr int vector_fields() {
  int count = 0;
  for (const InteractionField& field : Law::fields) count += field.turning == Turning::scalar ? 0 : 1;
  return count;
}
template <class Law>
constexpr int column_of_vector(int which) {
  int column = 0;
  for (const InteractionField& field : Law::fields) {
    if (field.turning != Turning::scalar && which-- == 0) return column;
    column += field.turning == Turning::scalar ? 1 : 3;
  }
  return column;
}

/// What the passes over a chunk hand on. As in pairs.hpp a pass ends with its roots (bonds of 1,000 spheres, eight
/// lanes: 0.77 of the time of one pass).
template <int vectors>
struct SpaceInteractionScratch {
  TripleColumn normal;    ///< the branch first
  TripleColumn velocity;  ///< of the centres; then the slip
  TripleColumn turn;
  ScratchColumn length, twist;
  TripleColumn history[vectors > 0 ? vectors : 1];
  ScratchColumn restoring[vectors > 0 ? vectors : 1];  ///< TurnedHistory::factor
};

/// Branches and motion of the centres.
template <int W, bool Advance, class Scratch>
inline __attribute__((always_inline)) void interaction_places(const StepConstants& c, const InteractionArrays& p,
                                                              const double* rows, long first, long count, Scratch& s) {
  using V = typename Lanes<W>::V;
  const double half_dt = 0.5 * c.dt;
  for (long k = 0; k < count; k += W) {
    const long at = first + k;
    V d[4];
    gather_differences<W>(rows, p.row_i + at, p.row_j + at, d);
    const Triple<V> b = interaction_branch<V>(c, p, at, {d[0], d[1], d[2]});
    s.normal.store(k, b);
    if constexpr (Advance) {
      V u[4];
      gather_differences<W>(rows + 4, p.row_i + at, p.row_j + at, u);
      const Triple<V> x = plus(b, V{} - half_dt, {u[0], u[1], u[2]});
      s.velocity.store(k, Triple<V>{u[0] + (c.rate.xx * x.x + (c.rate.xy * x.y + c.rate.xz * x.z)),
                                    u[1] + (c.rate.yy * x.y + c.rate.yz * x.z), u[2] + c.rate.zz * x.z});
    }
    store_as(s.length.at + k, square_root(dot(b, b)));
  }
}

/// Normal, slip, turn; the vectors that turn with the pair.
template <class Law, int W, bool Advance, class Scratch>
inline __attribute__((always_inline)) void interaction_motion(const StepConstants& c, const InteractionArrays& p,
                                                              const double* rows, long first, long count, Scratch& s) {
  using V = typename Lanes<W>::V;
  const V zero = V{}, one = zero + 1.0;
  for (long k = 0; k < count; k += W) {
    const long at = first + k;
    const V length = load_as<V>(s.length.at + k);
    const Triple<V> n = times(one / length, s.normal.template load<V>(k));
    s.normal.store(k, n);
    if constexpr (Advance) {
      const std::int32_t *i = p.row_i + at, *j = p.row_j + at;
      V si[4], sj[4];
      ColumnsOf<W>::load([=](int lane) { return rows + i[lane] + 8; }, si);
      ColumnsOf<W>::load([=](int lane) { return rows + j[lane] + 8; }, sj);
      const V half_gap = 0.5 * (length - (si[3] + sj[3]));
      const V arm_i = si[3] + half_gap, arm_j = sj[3] + half_gap;
      const Triple<V> arms = {(arm_j * sj[0] + arm_i * si[0]) + c.spin[0] * length,
                              (arm_j * sj[1] + arm_i * si[1]) + c.spin[1] * length,
                              (arm_j * sj[2] + arm_i * si[2]) + c.spin[2] * length};
      const Triple<V> v = s.velocity.template load<V>(k), along = plus(v, zero - dot(n, v), n);
      s.velocity.store(k, times(zero + c.dt, plus(along, zero - one, cross(arms, n))));
      s.turn.store(k, times(zero + c.dt, Triple<V>{sj[0] - si[0], sj[1] - si[1], sj[2] - si[2]}));
      const V twist =
          (0.5 * c.dt) * dot(n, Triple<V>{(si[0] + sj[0]) + 2.0 * c.spin[0], (si[1] + sj[1]) + 2.0 * c.spin[1],
                                          (si[2] + sj[2]) + 2.0 * c.spin[2]});
      for (int which = 0; which < vector_fields<Law>(); ++which) {
        const TurnedHistory<V> turned =
            turned_history(load_triple<V>(p.column + column_of_vector<Law>(which), at), n, twist, true);
        s.history[which].store(k, turned.vector);
        store_as(s.restoring[which].at + k, turned.factor);
      }
    }
  }
}

/// Forces of the law, and their rows.
template <class Law, int W, bool Advance, class Scratch>
inline __attribute__((always_inline)) void interaction_forces(const InteractionArrays& p, long first, long count,
                                                              const Scratch& s) {
  using V = typename Lanes<W>::V;
  const V zero = V{};
  constexpr int vectors = vector_fields<Law>();
  for (long k = 0; k < count; k += W) {
    const long at = first + k;
    SpaceTurn<V> m;
    m.n = s.normal.template load<V>(k);
    m.length = load_as<V>(s.length.at + k);
    Triple<V> turned[vectors > 0 ? vectors : 1];
    if constexpr (Advance) {
      m.slip = s.velocity.template load<V>(k);
      m.turn = s.turn.template load<V>(k);
      for (int which = 0; which < vectors; ++which)
        turned[which] = times(load_as<V>(s.restoring[which].at + k), s.history[which].template load<V>(k));
    } else {
      for (int which = 0; which < vectors; ++which)
        turned[which] = load_triple<V>(p.column + column_of_vector<Law>(which), at);
    }
    const SpaceForces<V> f = Law::template in_space<Advance, V>(p, at, m, turned);
    const V radius_i = load_as<V>(p.radius_i + at), radius_j = load_as<V>(p.radius_j + at);
    const V half_gap = 0.5 * (m.length - (radius_i + radius_j));
    const Triple<V> force = plus(f.tangential, f.normal, m.n), turning = cross(m.n, f.tangential);
    const V first_half[4] = {force.x, force.y, force.z, zero - half_gap};
    const V second_half[4] = {turning.x, turning.y, turning.z, zero};
    rows_of<W>(first_half, p.force + 8 * at, 8);
    rows_of<W>(second_half, p.force + 8 * at + 4, 8);
    store_triple(p.moment, at, f.moment);
  }
}

template <class Law, int W, bool Advance>
void space_interactions(const StepConstants& constants, const InteractionArrays& arrays, const double* rows, long begin,
                        long end) {
  const StepConstants c = constants;
  const InteractionArrays p = arrays;
  SpaceInteractionScratch<vector_fields<Law>()> scratch;
  for (long first = begin; first < end; first += chunk_pairs) {
    const long count = end - first < chunk_pairs ? end - first : chunk_pairs;
    interaction_places<W, Advance>(c, p, rows, first, count, scratch);
    interaction_motion<Law, W, Advance>(c, p, rows, first, count, scratch);
    interaction_forces<Law, W, Advance>(p, first, count, scratch);
  }
}

}  // namespace
}  // namespace rvelab
