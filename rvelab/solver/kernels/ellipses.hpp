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
  ScratchColumn matrix_i[4], matrix_j[4], determinant_i, determinant_j;
  ScratchColumn nx, ny, overlap;
  ScratchColumn reach_i, reach_j;  ///< h
  ScratchColumn turn_i, turn_j;    ///< h' - f'/2
  ScratchColumn along, opening;    ///< relative velocity of the centres over the step, along t and along n
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
      const EllipseMatrix<V> of_grain = matrix_from(m[0], m[1], m[2], m[3]);
      store_as(matrix[0].at + k, of_grain.xx);
      store_as(matrix[1].at + k, of_grain.xy);
      store_as(matrix[2].at + k, of_grain.yy);
      store_as(matrix[3].at + k, of_grain.sharpest);
    }
  }
}

template <class V>
inline __attribute__((always_inline)) EllipsePair<V> pair_in(const EllipseScratch& s, long k) {
  const auto matrix = [&](const ScratchColumn* m) {
    return EllipseMatrix<V>{load_as<V>(m[0].at + k), load_as<V>(m[1].at + k), load_as<V>(m[2].at + k),
                            load_as<V>(m[3].at + k)};
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
  const V half_slope = 0.5 * g.slope;
  store_as(s.overlap.at + k, g.overlap);
  store_as(s.reach_i.at + k, g.support_i);
  store_as(s.reach_j.at + k, g.support_j);
  store_as(s.turn_i.at + k, g.turned_i - half_slope);
  store_as(s.turn_j.at + k, g.turned_j - half_slope);
}

/// f of W pairs at their directions, which turn where it is not least yet; whether one does. `evaluation`: the first
/// one turns them in any case; after the last, what has not ended is put down as too deep for steps.
template <class V>
inline __attribute__((always_inline)) bool turn_downhill(EllipseScratch& s, long k, int evaluation) {
  const EllipsePair<V> pair = pair_in<V>(s, k);
  Direction<V> n = direction_in<V>(s, k);
  const V det_i = load_as<V>(s.determinant_i.at + k), det_j = load_as<V>(s.determinant_j.at + k);
  EllipseGap<V> gap = ellipse_gap(pair, n, det_i, det_j);
  if (evaluation == 1) {
    put_direction(s, k, next_direction(n, gap));
    return true;
  }
  const auto open = is_open(gap);
  if (evaluation < halley_steps && any_of(open)) {
    const Direction<V> next = next_direction(n, gap);
    put_direction(s, k, Direction<V>{open ? next.x : n.x, open ? next.y : n.y});
    return true;
  }
  turn_to_least(pair, n, gap);
  const V infinite = V{} + __builtin_inf();
  gap.overlap = open ? infinite : gap.overlap;
  put_direction(s, k, n);
  put_gap(s, k, gap);
  return false;
}

/// Leaves to the search what the steps did not end or what is too deep for them.
template <class V>
__attribute__((noinline)) void search_block(EllipseScratch& s, long k) {
  const EllipsePair<V> pair = pair_in<V>(s, k);
  Direction<V> n = direction_in<V>(s, k);
  const V overlap = load_as<V>(s.overlap.at + k);
  const auto deep = overlap > pair.i.sharpest + pair.j.sharpest;
  search_lanes(deep, pair, n);
  put_direction(s, k, n);
  const EllipseGap<V> found = ellipse_gap(pair, n);
  const V half_slope = 0.5 * found.slope;
  const auto put = [&](ScratchColumn& column, V value) {
    store_as(column.at + k, deep ? value : load_as<V>(column.at + k));
  };
  put(s.overlap, found.overlap);
  put(s.reach_i, found.support_i);
  put(s.reach_j, found.support_j);
  put(s.turn_i, found.turned_i - half_slope);
  put(s.turn_j, found.turned_j - half_slope);
}

/// What closest_gap finds, for the pairs of a chunk side by side: roots and divisions of one block of lanes fill the
/// time of another's, where each to its end left the processor waiting (a sub-step takes 0.82 of that time with eight
/// lanes, 0.77 with four).
template <class T>
inline __attribute__((always_inline)) void ellipse_normals(const StepConstants& c, const PairArrays& p, long first,
                                                           long count, EllipseScratch& s) {
  using V = typename Lanes<T::W>::V;
  for (long k = 0; k < count; k += T::W) {
    EllipsePair<V> pair = pair_in<V>(s, k);
    if (p.shifted[std::size_t(first + k) / 8]) {
      add_image_in_plane(c, p, first + k, pair.x, pair.y);
      store_as(s.dx.at + k, pair.x);
      store_as(s.dy.at + k, pair.y);
    }
    store_as(s.determinant_i.at + k, determinant(pair.i));
    store_as(s.determinant_j.at + k, determinant(pair.j));
    put_direction(s, k, first_direction(pair));
  }
  for (long k = 0; k < count; k += T::W) turn_downhill<V>(s, k, 1);
  long blocks[chunk_pairs / T::W], open = 0;
  for (long k = 0; k < count; k += T::W) {
    blocks[open] = k;
    open += turn_downhill<V>(s, k, 2);
  }
  for (int evaluation = 3; open > 0; ++evaluation) {
    const long all = open;
    open = 0;
    for (long block = 0; block < all; ++block) {
      const long k = blocks[block];
      if (turn_downhill<V>(s, k, evaluation)) blocks[open++] = k;
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
    const V deepest = load_as<V>(s.matrix_i[3].at + k) + load_as<V>(s.matrix_j[3].at + k);
    if (any_of(load_as<V>(s.overlap.at + k) > deepest)) search_block<V>(s, k);
    if constexpr (T::Advance || T::Dashpot) {
      const Direction<V> n = direction_in<V>(s, k);
      const V du = load_as<V>(s.du.at + k), dv = load_as<V>(s.dv.at + k);
      const V px = load_as<V>(s.dx.at + k) - half_dt * du, py = load_as<V>(s.dy.at + k) - half_dt * dv;
      const V vx = du + (c.rate.xx * px + c.rate.xy * py), vy = dv + c.rate.yy * py;
      store_as(s.along.at + k, n.x * vy - n.y * vx);
      if constexpr (T::Dashpot) store_as(s.opening.at + k, n.x * vx + n.y * vy);
    }
  }
}

/// What PlaceKernel asks for.
template <int W>
void ellipse_pair_places(const StepConstants& c, const PairArrays& p, const double* rows, long begin, long end,
                         double* places) {
  using T = PairTraits<W, false, Slip::consistent, false, false>;
  using V = typename Lanes<W>::V;
  EllipseScratch s;
  for (long first = begin; first < end; first += chunk_pairs) {
    const long count = end - first < chunk_pairs ? end - first : chunk_pairs;
    ellipse_rows<T>(p, rows, first, count, s);
    ellipse_places<T>(c, p, first, count, s);
    for (long k = 0; k < count; k += W) {
      const V near[4] = {load_as<V>(s.nx.at + k), load_as<V>(s.ny.at + k), load_as<V>(s.overlap.at + k),
                         load_as<V>(s.reach_i.at + k)},
              far[4] = {load_as<V>(s.reach_j.at + k), load_as<V>(s.turn_i.at + k), load_as<V>(s.turn_j.at + k), V{}};
      double* const row = places + place_row_length * (first + k);
      rows_of<W>(near, row, place_row_length);
      rows_of<W>(far, row + 4, place_row_length);
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
    constexpr int W = T::W;
    using V = typename Lanes<W>::V;
    const double half_dt = 0.5 * c.dt, cell_spin = c.spin[2];
    for (long k = 0; k < count; k += W) {
      double* row = g.rows + length * (first + k);
      V a[4];
      columns_of<W>(row + 4, length, a);
      const V x = a[1], y = a[2], axes_gap = a[3];
      const V sharpest = Lanes<W>::collected([=](int lane) { return row[length * lane + 11]; });
      const V w = load_as<V>(s.w.at + k) + cell_spin, u = load_as<V>(s.u.at + k), v = load_as<V>(s.v.at + k);
      const V speed = square_root(u * u + v * v) + axes_gap * magnitude_of(w), squared = speed * speed;
      fastest = (squared > fastest) ? squared : fastest;
      const V q = half_dt * w;
      const V inverse = 1.0 / (1.0 + q * q), cosine = (1.0 - q * q) * inverse, sine = (q + q) * inverse;
      const V tx = cosine * x - sine * y, ty = cosine * y + sine * x;
      const V shorter = 1.5 - 0.5 * (tx * tx + ty * ty);
      const Direction<V> e = {tx * shorter, ty * shorter};
      const V minor = load_as<V>(g.turn_first + first + k), difference = load_as<V>(g.turn_second + first + k);
      const EllipseMatrix<V> m = ellipse_matrix(e, minor, difference, sharpest);
      const V spin_and_axis[4] = {load_as<V>(s.w.at + k), e.x, e.y, axes_gap},
              matrix[4] = {m.xx, m.xy, m.yy, m.sharpest};
      rows_of<W>(spin_and_axis, row + 4, length);
      rows_of<W>(matrix, row + 8, length);
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
