// The geometry of pairs of ellipses for the contact update in the plane (plane.hpp): normal and overlap by
// ellipse_overlap.hpp, the contact point midway between the two support points. Their grain rows are {x, y, u, v, w,
// ex, ey, a - b, Mxx, Mxy, Myy, b^2/a} with e along the long axis and M = a^2 e e + b^2 (1 - e e).
//
// The arms from the centres to the contact point: r_i.n = h_i - delta/2, r_j.n = delta/2 - h_j, r_i.t = h_i' - f'/2,
// r_j.t = f'/2 - h_j'. So r_i - r_j is the branch whatever n is, and moments balance to rounding. The overlap grows as
// the contact points close, d delta/dt = -opening, since h_i(n) changes by -w_i h_i' where i turns: the springs do no
// work but their own.
#pragma once

#include "rvelab/contact/hertz_curvature.hpp"
#include "rvelab/solver/kernels/ellipse_search.hpp"
#include "rvelab/solver/kernels/integrate_discs.hpp"
#include "rvelab/solver/kernels/plane.hpp"

namespace rvelab {
namespace {

/// What the passes hand on.
struct EllipseScratch {
  ScratchColumn dx, dy, du, dv;  ///< place and velocity of j less those of i; then the branch
  ScratchColumn spin_i, spin_j;
  ScratchColumn matrix_i[4], matrix_j[4];
  ScratchColumn nx, ny, overlap;
  ScratchColumn reach_i, reach_j;         ///< h
  ScratchColumn turn_i, turn_j;           ///< h'; then h' - f'/2
  ScratchColumn slope, curvature, third;  ///< of f
  ScratchColumn along, opening;           ///< relative velocity of the centres over the step, along t and along n
};

/// The matrix of an ellipse from four columns. Padding grains have none: they count as discs of 1e-50 m.
template <class V>
inline __attribute__((always_inline)) EllipseMatrix<V> matrix_from(const V& xx, const V& xy, const V& yy,
                                                                   const V& sharpest) {
  return {xx + 1e-100, xy, yy + 1e-100, sharpest};
}

/// Grain rows to columns.
template <class T>
inline __attribute__((always_inline)) void ellipse_rows(const PairArrays& p, const double* rows, long first, long count,
                                                        EllipseScratch& out) {
  constexpr int W = T::W < 4 ? T::W : 4;
  using V = typename Lanes<W>::V;
  for (long k = 0; k < count; k += W) {
    std::int32_t i[W], j[W];
    for (int lane = 0; lane < W; ++lane) i[lane] = p.row_i[first + k + lane], j[lane] = p.row_j[first + k + lane];
    motion_to_columns<T, W>(rows, i, j, k, out);
    for (int side = 0; side < 2; ++side) {
      V m[4];
      const std::int32_t* grain = side == 0 ? i : j;
      ScratchColumn* matrix = side == 0 ? out.matrix_i : out.matrix_j;
      ColumnsOf<W>::load([=](int lane) { return rows + grain[lane] + 8; }, m);
      for (int column = 0; column < 4; ++column) store_as(matrix[column].at + k, m[column]);
    }
  }
}

template <class V>
inline __attribute__((always_inline)) EllipsePair<V> pair_in(const EllipseScratch& s, long k) {
  const auto matrix = [&](const ScratchColumn* m) {
    return matrix_from(load_as<V>(m[0].at + k), load_as<V>(m[1].at + k), load_as<V>(m[2].at + k),
                       load_as<V>(m[3].at + k));
  };
  return {load_as<V>(s.dx.at + k), load_as<V>(s.dy.at + k), matrix(s.matrix_i), matrix(s.matrix_j)};
}

template <class V>
inline __attribute__((always_inline)) void put_direction(EllipseScratch& s, long k, Direction<V> n) {
  store_as(s.nx.at + k, n.x);
  store_as(s.ny.at + k, n.y);
}
template <class V>
inline __attribute__((always_inline)) Direction<V> direction_in(const EllipseScratch& s, long k) {
  return {load_as<V>(s.nx.at + k), load_as<V>(s.ny.at + k)};
}

template <class V>
inline __attribute__((always_inline)) void put_gap(EllipseScratch& s, long k, const EllipseGap<V>& g) {
  store_as(s.reach_i.at + k, g.support_i);
  store_as(s.reach_j.at + k, g.support_j);
  store_as(s.turn_i.at + k, g.turned_i);
  store_as(s.turn_j.at + k, g.turned_j);
  store_as(s.overlap.at + k, g.overlap);
  store_as(s.slope.at + k, g.slope);
  store_as(s.curvature.at + k, g.curvature);
  store_as(s.third.at + k, g.third);
}
template <class V>
inline __attribute__((always_inline)) EllipseGap<V> gap_in(const EllipseScratch& s, long k) {
  return {load_as<V>(s.reach_i.at + k),   load_as<V>(s.reach_j.at + k), load_as<V>(s.turn_i.at + k),
          load_as<V>(s.turn_j.at + k),    load_as<V>(s.overlap.at + k), load_as<V>(s.slope.at + k),
          load_as<V>(s.curvature.at + k), load_as<V>(s.third.at + k)};
}

/// Normals and f there: closest_gap of all pairs of a chunk, a step at a time, so that the roots and divisions of one
/// block of lanes fill the time of another's and no branch waits for them (AVX-512: 0.00 of the time that a loop to the
/// end of each block takes).
template <class T>
inline __attribute__((always_inline)) void ellipse_normals(const StepConstants& c, const PairArrays& p, long first,
                                                           long count, EllipseScratch& s) {
  using V = typename Lanes<T::W>::V;
  for (long k = 0; k < count; k += T::W) {
    V bx = load_as<V>(s.dx.at + k), by = load_as<V>(s.dy.at + k);
    add_image_in_plane(c, p, first + k, bx, by);
    store_as(s.dx.at + k, bx);
    store_as(s.dy.at + k, by);
    put_direction(s, k, first_direction(pair_in<V>(s, k)));
  }
  long open_blocks[chunk_pairs / T::W], open = 0;
  for (long k = 0; k < count; k += T::W) {
    const EllipseGap<V> gap = ellipse_gap(pair_in<V>(s, k), direction_in<V>(s, k));
    put_gap(s, k, gap);
    open_blocks[open] = k;
    open += any_of(is_open(gap));
  }
  for (int step = 1; step < halley_steps && open > 0; ++step) {
    const long blocks = open;
    open = 0;
    for (long block = 0; block < blocks; ++block) {
      const long k = open_blocks[block];
      const EllipseGap<V> last = gap_in<V>(s, k);
      const Direction<V> n = direction_in<V>(s, k), next = next_direction(n, last);
      const auto moves = is_open(last);
      const Direction<V> to = {moves ? next.x : n.x, moves ? next.y : n.y};
      const EllipseGap<V> gap = ellipse_gap(pair_in<V>(s, k), to);
      put_direction(s, k, to);
      put_gap(s, k, gap);
      open_blocks[open] = k;
      open += any_of(is_open(gap));
    }
  }
}

/// Normal, overlap, arms and the motion of the centres. Not inlined: it is long, and the same for every law.
template <class T>
__attribute__((noinline)) void ellipse_places(const StepConstants& c, const PairArrays& p, long first, long count,
                                              EllipseScratch& s) {
  using V = typename Lanes<T::W>::V;
  const double half_dt = 0.5 * c.dt;
  ellipse_normals<T>(c, p, first, count, s);
  for (long k = 0; k < count; k += T::W) {
    const EllipsePair<V> pair = pair_in<V>(s, k);
    Direction<V> n = direction_in<V>(s, k);
    EllipseGap<V> gap = gap_in<V>(s, k);
    if (search_where_needed(pair, n, gap)) {
      put_direction(s, k, n);
      put_gap(s, k, gap);
    }
    store_as(s.turn_i.at + k, gap.turned_i - 0.5 * gap.slope);
    store_as(s.turn_j.at + k, gap.turned_j - 0.5 * gap.slope);
    if constexpr (T::Advance || T::Dashpot) {
      const V du = load_as<V>(s.du.at + k), dv = load_as<V>(s.dv.at + k);
      const V px = pair.x - half_dt * du, py = pair.y - half_dt * dv;
      const V vx = du + (c.rate.xx * px + c.rate.xy * py), vy = dv + c.rate.yy * py;
      store_as(s.along.at + k, n.x * vy - n.y * vx);
      if constexpr (T::Dashpot) store_as(s.opening.at + k, n.x * vx + n.y * vy);
    }
  }
}

/// What turns with an ellipse: the axis e by the whole spin seen in the cell frame, w' + axial(W), and with it M.
///
/// The turn is Cayley's, of the angle 2 atan(dt w/2): of second order as the step is. Rounding would make e longer or
/// shorter in the course of 1e8 steps; 1/|e| = 3/2 - |e|^2/2 to first order keeps it.
///
/// Lists have to know how far surfaces come, not centres: a turn by theta moves the support h of an ellipse by at most
/// (a - b) |sin theta| (assembly/oriented_bounds.hpp).
struct EllipseRows {
  static constexpr int length = Ellipse::row_length;
  static constexpr bool turns = true;

  /// `fastest`: (|v'| + (a - b) |w|)^2, the largest so far.
  template <class T, class Fastest>
  static inline __attribute__((always_inline)) void turn(const StepConstants& c, const GrainArrays& g, long first,
                                                         long count, const DiscColumns& s, Fastest& fastest) {
    constexpr int W = T::W < 4 ? T::W : 4;
    using V = typename Lanes<W>::V;
    const double half_dt = 0.5 * c.dt, cell_spin = c.spin[2];
    for (long k = 0; k < count; k += W) {
      double* row = g.rows + length * (first + k);
      const V x = Lanes<W>::collected([=](int lane) { return row[length * lane + 5]; });
      const V y = Lanes<W>::collected([=](int lane) { return row[length * lane + 6]; });
      const V w = load_as<V>(s.w.at + k) + cell_spin, u = load_as<V>(s.u.at + k), v = load_as<V>(s.v.at + k);
      const V axes_gap = Lanes<W>::collected([=](int lane) { return row[length * lane + 7]; });
      const V speed = square_root(u * u + v * v) + axes_gap * magnitude_of(w), squared = speed * speed;
      fastest = (squared > fastest) ? squared : fastest;
      const V q = half_dt * w;
      const V inverse = 1.0 / (1.0 + q * q), cosine = (1.0 - q * q) * inverse, sine = (q + q) * inverse;
      const V tx = cosine * x - sine * y, ty = cosine * y + sine * x;
      const V shorter = 1.5 - 0.5 * (tx * tx + ty * ty);
      const Direction<V> e = {tx * shorter, ty * shorter};
      const V minor = load_as<V>(g.turn_first + first + k), difference = load_as<V>(g.turn_second + first + k);
      const EllipseMatrix<V> m = ellipse_matrix(e, minor, difference, V{});
      const V columns[5] = {e.x, e.y, m.xx, m.xy, m.yy};
      constexpr int at[5] = {5, 6, 8, 9, 10};
      for (int column = 0; column < 5; ++column) {
        double values[W];
        std::memcpy(values, &columns[column], sizeof(V));
        for (int lane = 0; lane < W; ++lane) row[length * lane + at[column]] = values[lane];
      }
    }
  }
};

/// What the contact update in the plane (plane.hpp) asks of a shape.
struct Ellipses {
  using By = Ellipse;
  using Scratch = EllipseScratch;
  using Rows = EllipseRows;

  template <class T>
  static inline __attribute__((always_inline)) void locate(const StepConstants& c, const PairArrays& p,
                                                           const double* rows, long first, long count, Scratch& s) {
    ellipse_rows<T>(p, rows, first, count, s);
    ellipse_places<T>(c, p, first, count, s);
  }
  template <class T>
  static inline __attribute__((always_inline)) auto contact(const StepConstants& c, const PairArrays& p, long at,
                                                            long k, const Scratch& s) {
    using V = typename Lanes<T::W>::V;
    PlaneContact<V> contact;
    const V reach_i = load_as<V>(s.reach_i.at + k), reach_j = load_as<V>(s.reach_j.at + k);
    contact.nx = load_as<V>(s.nx.at + k);
    contact.ny = load_as<V>(s.ny.at + k);
    contact.overlap = load_as<V>(s.overlap.at + k);
    contact.turn_i = load_as<V>(s.turn_i.at + k);
    contact.turn_j = load_as<V>(s.turn_j.at + k);
    const V half_overlap = 0.5 * contact.overlap;
    contact.lever_i = half_overlap - reach_i;
    contact.lever_j = half_overlap - reach_j;
    if constexpr (T::Curvature)
      contact.radius_ratio =
          hertz_radius_ratio(load_as<V>(p.radius_i + at), reach_i, load_as<V>(p.radius_j + at), reach_j);
    if constexpr (T::Advance || T::Dashpot) {
      const V spin_i = load_as<V>(s.spin_i.at + k), spin_j = load_as<V>(s.spin_j.at + k);
      contact.slip_rate =
          (load_as<V>(s.along.at + k) - ((reach_j * spin_j + reach_i * spin_i) + c.spin[2] * (reach_i + reach_j))) +
          half_overlap * ((spin_j + spin_i) + 2.0 * c.spin[2]);
      if constexpr (T::Rolling) contact.spin_difference = spin_j - spin_i;
      if constexpr (T::Dashpot)
        contact.opening = load_as<V>(s.opening.at + k) +
                          ((spin_i + c.spin[2]) * contact.turn_i + (spin_j + c.spin[2]) * contact.turn_j);
    }
    return contact;
  }
  template <int W>
  static bool may_touch(const StepConstants& c, const PairArrays& p, const double* rows, long first);
};

/// Whether one of eight pairs is not shown to be apart along its first direction v, whatever its length.
template <int W>
__attribute__((noinline)) bool Ellipses::may_touch(const StepConstants& c, const PairArrays& p, const double* rows,
                                                   long first) {
  using V = typename Lanes<W>::V;
  for (long at = first; at < first + 8; at += W) {
    V d[2], i[4], j[4];
    gather_place_differences<W>(rows, p.row_i + at, p.row_j + at, d);
    ColumnsOf<W>::load([=](int lane) { return rows + p.row_i[at + lane] + 8; }, i);
    ColumnsOf<W>::load([=](int lane) { return rows + p.row_j[at + lane] + 8; }, j);
    add_image_in_plane(c, p, at, d[0], d[1]);
    const EllipsePair<V> pair = {d[0], d[1], matrix_from(i[0], i[1], i[2], i[3]), matrix_from(j[0], j[1], j[2], j[3])};
    if (any_of(!shows_apart(pair, leaving_direction(pair)))) return true;
  }
  return false;
}

}  // namespace
}  // namespace rvelab
