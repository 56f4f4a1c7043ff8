// The loops over interactions other than contacts: geometry and motion of W pairs, the law, the force rows. Slip and
// arms are those of consistent contacts (contact/README.md): the point halves the gap, so that work and moments
// balance.
#pragma once

#include "rvelab/interaction/laws.hpp"
#include "rvelab/solver/kernels/pairs.hpp"

namespace rvelab {
namespace {

/// Branches; unlike those of contacts nearly all that matter are near, and images are added without asking.
template <class V, int D>
inline __attribute__((always_inline)) Vec<V, D> branch_of(const StepConstants& c, const InteractionArrays& p, long at,
                                                          const Vec<V, D>& d) {
  return branch_with_image(c.lattice, d, load_vec<V, D>(p.image, at));
}

template <class Law, int W, bool Advance>
void plane_interactions(const StepConstants& constants, const InteractionArrays& arrays, const double* rows, long begin,
                        long end) {
  using V = typename Lanes<W>::V;
  const StepConstants c = constants;
  const InteractionArrays p = arrays;
  for (long at = begin; at < end; at += W) {
    V following[2];
    const Vec<V, 2> b = branch_of(c, p, at, gather_differences<W, 2>(rows, p.row_i + at, p.row_j + at, following));
    PlaneMotion<V> m;
    m.length = square_root(dot(b, b));
    const Vec<V, 2> n = {b.x / m.length, b.y / m.length};
    const V radius_i = load_as<V>(p.radius_i + at), radius_j = load_as<V>(p.radius_j + at);
    const V half_gap = 0.5 * (m.length - (radius_i + radius_j));
    const V arm_i = radius_i + half_gap, arm_j = radius_j + half_gap;
    if constexpr (Advance) {
      const V spin_i = gather_spins<W>(rows, p.row_i + at), spin_j = gather_spins<W>(rows, p.row_j + at);
      const Vec<V, 2> v = relative_velocity(c, b, first_of<2>(following));
      m.slip = c.dt * ((n.x * v.y - n.y * v.x) - ((arm_j * spin_j + arm_i * spin_i) + c.spin[2] * m.length));
      m.turn = c.dt * (spin_j - spin_i);
    }
    const PlaneForces<V> f = Law::template in_plane<Advance, V>(p, at, m);
    const V columns[4] = {n.x * f.normal - n.y * f.tangential, n.y * f.normal + n.x * f.tangential,
                          f.moment - arm_j * f.tangential, (V{} - f.moment) - arm_i * f.tangential};
    using L = Lanes<W>;
    typename L::Quad force[W];
    L::untranspose(columns, force);
    for (int lane = 0; lane < W; ++lane) {
      store_as(p.force + force_row_length(2) * (at + lane), force[lane]);
      double *on_i = p.resultants + p.row_i[at + lane], *on_j = p.resultants + p.row_j[at + lane];
      store_as(on_j, L::add(quad_at<W>(on_j), force[lane]));
      store_as(on_i, L::add(quad_at<W>(on_i), L::seen_from_i(force[lane])));
    }
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
  TripleColumn normal;
  TripleColumn velocity;  ///< of the centres; then the slip
  TripleColumn turn;
  ScratchColumn length, arm_j;
  TripleColumn history[vectors > 0 ? vectors : 1];
  ScratchColumn restoring[vectors > 0 ? vectors : 1];  ///< TurnedHistory::factor
};

/// Normals and motion of the centres.
template <int W, bool Advance, class Scratch>
inline __attribute__((always_inline)) void locate_interactions(const StepConstants& c, const InteractionArrays& p,
                                                               const double* rows, long first, long count, Scratch& s) {
  using V = typename Lanes<W>::V;
  for (long k = 0; k < count; k += W) {
    const long at = first + k;
    const Triple<V> b = branch_of(c, p, at, gather_differences<W, 3>(rows, p.row_i + at, p.row_j + at));
    const V length = square_root(dot(b, b)), one = V{} + 1.0;
    s.normal.store(k, times(one / length, b));
    store_as(s.length.at + k, length);
    if constexpr (Advance)
      s.velocity.store(k, relative_velocity(c, b, gather_differences<W, 3>(rows + 4, p.row_i + at, p.row_j + at)));
  }
}

/// Slip, turn; the vectors that turn with the pair.
template <class Law, int W, bool Advance, class Scratch>
inline __attribute__((always_inline)) void interaction_motion(const StepConstants& c, const InteractionArrays& p,
                                                              const double* rows, long first, long count, Scratch& s) {
  using V = typename Lanes<W>::V;
  const V zero = V{}, one = zero + 1.0;
  for (long k = 0; k < count; k += W) {
    const long at = first + k;
    const V length = load_as<V>(s.length.at + k);
    const Triple<V> n = s.normal.template load<V>(k);
    if constexpr (Advance) {
      const std::int32_t *i = p.row_i + at, *j = p.row_j + at;
      V si[4], sj[4];
      ColumnsOf<W>::load([=](int lane) { return rows + i[lane] + 8; }, si);
      ColumnsOf<W>::load([=](int lane) { return rows + j[lane] + 8; }, sj);
      // a_j w_j + a_i w_i + l W = l/2 (w_i + w_j + 2 W) + (r_j - r_i)/2 (w_j - w_i), since the arms a add up to l.
      const Triple<V> of_i = first_of<3>(si), of_j = first_of<3>(sj), difference = of_j - of_i;
      const Triple<V> sum = with_cell_spin(c, of_i + of_j, 2.0);
      const V half = 0.5 * length, more_at_j = 0.5 * (sj[3] - si[3]);
      store_as(s.arm_j.at + k, half + more_at_j);
      const Triple<V> arms = plus(times(half, sum), more_at_j, difference);
      const Triple<V> v = s.velocity.template load<V>(k), along = minus(v, dot(n, v), n);
      s.velocity.store(k, times(zero + c.dt, minus(along, one, cross(arms, n))));
      s.turn.store(k, times(zero + c.dt, difference));
      const V twist = (0.5 * c.dt) * dot(n, sum);
      for (int which = 0; which < vector_fields<Law>(); ++which) {
        const TurnedHistory<V> turned =
            turned_history(load_vec<V>(p.column + column_of_vector<Law>(which), at), n, twist, true);
        s.history[which].store(k, turned.vector);
        store_as(s.restoring[which].at + k, turned.factor);
      }
    }
  }
}

/// Force rows, and what they give to both grains; the last of four numbers is unused. Without the sums, where
/// the grain loop gathered the rows as those of contacts, it took 106 instructions a grain more and this loop 55 less.
template <int W, class V>
inline __attribute__((always_inline)) void add_to_grains(const InteractionArrays& p, long at, const Triple<V>& force,
                                                         const Triple<V>& torque_j, const Triple<V>& torque_i) {
  using L = Lanes<W>;
  const V columns[3][4] = {{force.x, force.y, force.z, force.z},
                           {torque_j.x, torque_j.y, torque_j.z, torque_j.z},
                           {torque_i.x, torque_i.y, torque_i.z, torque_i.z}};
  typename L::Quad rows[3][W];
  for (int k = 0; k < 3; ++k) L::untranspose(columns[k], rows[k]);
#pragma GCC unroll 8
  for (int lane = 0; lane < W; ++lane) {
    double* row = p.force + force_row_length(3) * (at + lane);
    store_as(row, rows[0][lane]);
    store_as(row + 4, rows[1][lane]);
    double *on_i = p.resultants + p.row_i[at + lane], *on_j = p.resultants + p.row_j[at + lane];
    store_as(on_j, L::add(quad_at<W>(on_j), rows[0][lane]));
    store_as(on_j + 4, L::add(quad_at<W>(on_j + 4), rows[1][lane]));
    store_as(on_i, L::sub(quad_at<W>(on_i), rows[0][lane]));
    store_as(on_i + 4, L::add(quad_at<W>(on_i + 4), rows[2][lane]));
  }
}

/// Forces of the law, and their rows.
template <class Law, int W, bool Advance, class Scratch>
inline __attribute__((always_inline)) void interaction_forces(const InteractionArrays& p, long first, long count,
                                                              const Scratch& s) {
  using V = typename Lanes<W>::V;
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
        turned[which] = load_vec<V>(p.column + column_of_vector<Law>(which), at);
    }
    const SpaceForces<V> f = Law::template in_space<Advance, V>(p, at, m, turned);
    V arm_j;
    if constexpr (Advance)
      arm_j = load_as<V>(s.arm_j.at + k);
    else
      arm_j = 0.5 * m.length + 0.5 * (load_as<V>(p.radius_j + at) - load_as<V>(p.radius_i + at));
    const Triple<V> turning = cross(m.n, f.tangential), backward = times(arm_j - m.length, turning);
    add_to_grains<W>(p, at, plus(f.tangential, f.normal, m.n), minus(f.moment, arm_j, turning), backward - f.moment);
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
    locate_interactions<W, Advance>(c, p, rows, first, count, scratch);
    interaction_motion<Law, W, Advance>(c, p, rows, first, count, scratch);
    interaction_forces<Law, W, Advance>(p, first, count, scratch);
  }
}

}  // namespace
}  // namespace rvelab
