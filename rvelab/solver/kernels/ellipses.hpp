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
  VecColumn<2> branch, velocity;  ///< velocity: v' of j less that of i
  ScratchColumn spin_i, spin_j;
  ScratchColumn squared, form_i[3], form_j[3];  ///< BranchFrame
  ScratchColumn tangent, curvature, ended, deepest;
  VecColumn<2> normal;
  ScratchColumn overlap;
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

template <class V>
inline __attribute__((always_inline)) void put_form(ScratchColumn* to, long k, const SquaredSupport<V>& s) {
  store_as(to[0].at + k, s.along);
  store_as(to[1].at + k, s.mixed);
  store_as(to[2].at + k, s.across);
}
template <class V>
inline __attribute__((always_inline)) BranchFrame<V> frame_in(const EllipseScratch& s, long k) {
  const auto form = [&](const ScratchColumn* m) {
    return SquaredSupport<V>{load_as<V>(m[0].at + k), load_as<V>(m[1].at + k), load_as<V>(m[2].at + k)};
  };
  return {load_as<V>(s.squared.at + k), form(s.form_i), form(s.form_j)};
}

template <class V, int W>
inline __attribute__((always_inline)) EllipseMatrix<V> matrix_of(const typename Lanes<W>::Quad* quads) {
  V m[4];
  Lanes<W>::transpose(quads, m);
  return matrix_from(m[0], m[1], m[2], m[3]);
}

/// Grain rows to columns: branch, motion, and the pair in the frame of its branch, with its first direction.
template <int W, bool Moves>
inline __attribute__((always_inline)) void ellipse_rows(const StepConstants& c, const PairArrays& p, const double* rows,
                                                        long first, long count, EllipseScratch& s) {
  using L = Lanes<W>;
  using V = typename L::V;
  using Quad = typename L::Quad;
  for (long k = 0; k < count; k += W) {
    const std::int32_t *i = p.row_i + first + k, *j = p.row_j + first + k;
    Quad difference[W], of_i[W], of_j[W];
    for (int lane = 0; lane < W; ++lane) {
      const double *const row_i = rows + i[lane], *const row_j = rows + j[lane];
      difference[lane] = L::sub(quad_at<W>(row_j), quad_at<W>(row_i));
      of_i[lane] = quad_at<W>(row_i + 8);
      of_j[lane] = quad_at<W>(row_j + 8);
      if constexpr (Moves) {
        s.spin_i.at[k + lane] = row_i[4];
        s.spin_j.at[k + lane] = row_j[4];
      }
    }
    V d[4];
    L::transpose(difference, d);
    if constexpr (Moves) s.velocity.store(k, Vec<V, 2>{d[2], d[3]});
    const Vec<V, 2> branch = branch_of(c, p, first + k, first_of<2>(d));
    s.branch.store(k, branch);
    const EllipsePair<V> pair = {branch.x, branch.y, matrix_of<V, W>(of_i), matrix_of<V, W>(of_j)};
    const BranchFrame<V> frame = branch_frame(pair);
    store_as(s.squared.at + k, frame.squared);
    put_form(s.form_i, k, frame.i);
    put_form(s.form_j, k, frame.j);
    store_as(s.deepest.at + k, pair.i.sharpest + pair.j.sharpest);
    store_as(s.tangent.at + k, first_tangent(frame));
  }
}

/// Steps of W pairs; whether some have not ended.
template <class V>
inline __attribute__((always_inline)) bool first_step(EllipseScratch& s, long k) {
  const V t = load_as<V>(s.tangent.at + k);
  const TangentStep<V> step = tangent_step(frame_in<V>(s, k), t);
  store_as(s.curvature.at + k, step.curvature);
  if (!any_of(!step.near)) {
    store_as(s.tangent.at + k, step.next);
    return false;
  }
  const MaskOf<V> ended = step.near | step.apart;
  store_as(s.tangent.at + k, (step.apart & !step.near) ? t : step.next);
  store_as(s.ended.at + k, ended ? V{} + 1.0 : V{});
  return any_of(!ended);
}
template <class V>
__attribute__((noinline)) bool further_step(EllipseScratch& s, long k, bool last) {
  V t = load_as<V>(s.tangent.at + k), curvature = load_as<V>(s.curvature.at + k);
  MaskOf<V> ended = load_as<V>(s.ended.at + k) > 0.5;
  step_open_lanes(frame_in<V>(s, k), t, curvature, ended);
  store_as(s.tangent.at + k, (last && any_of(!ended)) ? (ended ? t : V{} + __builtin_nan("")) : t);
  store_as(s.curvature.at + k, curvature);
  store_as(s.ended.at + k, ended ? V{} + 1.0 : V{});
  return !last && any_of(!ended);
}

/// What closest_place finds, for the pairs of a chunk side by side: roots and divisions of one block of lanes fill the
/// time of another's, where each to its end left the processor waiting (a sub-step takes 0.82 of that time with eight
/// lanes, 0.77 with four).
template <int W>
inline __attribute__((always_inline)) void ellipse_directions(long count, EllipseScratch& s) {
  using V = typename Lanes<W>::V;
  long blocks[chunk_pairs / W], open = 0;
  for (long k = 0; k < count; k += W) {
    blocks[open] = k;
    open += first_step<V>(s, k);
  }
  for (int evaluation = 2; open > 0; ++evaluation) {
    const long all = open;
    open = 0;
    for (long block = 0; block < all; ++block) {
      const long k = blocks[block];
      if (further_step<V>(s, k, evaluation == halley_steps)) blocks[open++] = k;
    }
  }
}

/// The pair along its direction, to columns, with the motion of the centres; `Opens`: along n too.
template <bool Moves, bool Opens, class V>
inline __attribute__((always_inline)) void put_place(const StepConstants& c, const EllipsePlace<V>& place,
                                                     const Vec<V, 2>& branch, long k, EllipseScratch& s) {
  const V half_slope = 0.5 * place.slope;
  const Vec<V, 2> n = {place.n.x, place.n.y};
  s.normal.store(k, n);
  store_as(s.overlap.at + k, place.overlap);
  store_as(s.reach_i.at + k, place.support_i);
  store_as(s.reach_j.at + k, place.support_j);
  store_as(s.turn_i.at + k, place.turned_i - half_slope);
  store_as(s.turn_j.at + k, place.turned_j - half_slope);
  if constexpr (Moves) {
    const Vec<V, 2> v = relative_velocity(c, branch, s.velocity.load<V>(k));
    store_as(s.along.at + k, n.x * v.y - n.y * v.x);
    if constexpr (Opens) store_as(s.opening.at + k, dot(n, v));
  }
}

/// The same of pairs that take a step more or are too deep for steps. Seldom, and so not inlined.
template <int W, bool Moves, bool Opens>
__attribute__((noinline)) void put_far_place(const StepConstants& c, const PairArrays& p, const double* rows,
                                             long first, long k, EllipseScratch& s) {
  using V = typename Lanes<W>::V;
  const long at = first + k;
  const Vec<V, 2> b = s.branch.load<V>(k);
  const V t = load_as<V>(s.tangent.at + k);
  const BranchFrame<V> frame = frame_in<V>(s, k);
  EllipsePlace<V> place = place_along(frame, b.x, b.y, t);
  const MaskOf<V> settled = is_settled(place, load_as<V>(s.curvature.at + k));
  if (any_of(!settled)) place = settled_place(frame, b.x, b.y, t, settled);
  typename Lanes<W>::Quad of_i[W], of_j[W];
  for (int lane = 0; lane < W; ++lane) {
    of_i[lane] = quad_at<W>(rows + p.row_i[at + lane] + 8);
    of_j[lane] = quad_at<W>(rows + p.row_j[at + lane] + 8);
  }
  const EllipsePair<V> pair = {b.x, b.y, matrix_of<V, W>(of_i), matrix_of<V, W>(of_j)};
  const MaskOf<V> deep = !is_shallow(pair, place.overlap);
  if (any_of(deep)) place = searched_where(deep, pair, place);
  put_place<Moves, Opens>(c, place, b, k, s);
}

/// Normal, overlap, arms and the motion of the centres. Not inlined: it is long, and the same for every law.
template <int W, bool Moves, bool Opens>
__attribute__((noinline)) void locate_ellipses(const StepConstants& c, const PairArrays& p, const double* rows,
                                               long first, long count, EllipseScratch& s) {
  using V = typename Lanes<W>::V;
  ellipse_rows<W, Moves>(c, p, rows, first, count, s);
  ellipse_directions<W>(count, s);
  for (long k = 0; k < count; k += W) {
    const Vec<V, 2> b = s.branch.load<V>(k);
    const EllipsePlace<V> place = place_along(frame_in<V>(s, k), b.x, b.y, load_as<V>(s.tangent.at + k));
    put_place<Moves, Opens>(c, place, b, k, s);
    const MaskOf<V> found =
        is_settled(place, load_as<V>(s.curvature.at + k)) & (place.overlap <= load_as<V>(s.deepest.at + k));
    if (any_of(!found)) put_far_place<W, Moves, Opens>(c, p, rows, first, k, s);
  }
}

/// What PlaceKernel asks for.
template <int W>
void ellipse_pair_places(const StepConstants& c, const PairArrays& p, const double* rows, long begin, long end,
                         double* places) {
  using V = typename Lanes<W>::V;
  EllipseScratch s;
  for (long first = begin; first < end; first += chunk_pairs) {
    const long count = end - first < chunk_pairs ? end - first : chunk_pairs;
    locate_ellipses<W, false, false>(c, p, rows, first, count, s);
    for (long k = 0; k < count; k += W) {
      const Vec<V, 2> n = s.normal.load<V>(k);
      const V near[4] = {n.x, n.y, load_as<V>(s.overlap.at + k), load_as<V>(s.reach_i.at + k)},
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

  /// Of W grains from `first` on, which move with v and w; their speed is |v'| + (a - b) |w|.
  template <int W, class V>
  static inline __attribute__((always_inline)) void turn(const StepConstants& c, const GrainArrays& g, long first,
                                                         const Vec<V, 2>& v, V w, const V (&a)[4], LaneSums<W>& sums) {
    double* row = g.rows + length * first;
    const double half_dt = 0.5 * c.dt;
    const V x = a[1], y = a[2], axes_gap = a[3];
    const V sharpest = Lanes<W>::collected([=](int lane) { return row[length * lane + 11]; });
    const V spin = w + c.spin[2];
    const V speed = square_root(dot(v, v)) + axes_gap * magnitude_of(spin);
    sums.see_speed(speed * speed);
    const V q = half_dt * spin;
    const V inverse = 1.0 / (1.0 + q * q), cosine = (1.0 - q * q) * inverse, sine = (q + q) * inverse;
    const V tx = cosine * x - sine * y, ty = cosine * y + sine * x;
    const V shorter = 1.5 - 0.5 * (tx * tx + ty * ty);
    const Direction<V> e = {tx * shorter, ty * shorter};
    const V minor = load_as<V>(g.turn_first + first), difference = load_as<V>(g.turn_second + first);
    const EllipseMatrix<V> m = ellipse_matrix(e, minor, difference, sharpest);
    const V spin_and_axis[4] = {w, e.x, e.y, axes_gap}, matrix[4] = {m.xx, m.xy, m.yy, m.sharpest};
    rows_of<W>(spin_and_axis, row + 4, length);
    rows_of<W>(matrix, row + 8, length);
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
    locate_ellipses<T::W, T::Moves, T::Dashpot>(c, p, rows, first, count, s);
  }
  template <class T>
  static inline __attribute__((always_inline)) auto contact(const StepConstants& c, const PairArrays& p, long at,
                                                            long k, const Scratch& s) {
    using V = typename Lanes<T::W>::V;
    PlaneContact<V> contact;
    const V reach_i = load_as<V>(s.reach_i.at + k), reach_j = load_as<V>(s.reach_j.at + k);
    contact.n = s.normal.load<V>(k);
    contact.overlap = load_as<V>(s.overlap.at + k);
    contact.turn_i = load_as<V>(s.turn_i.at + k);
    contact.turn_j = load_as<V>(s.turn_j.at + k);
    const V half_overlap = 0.5 * contact.overlap;
    contact.lever_i = half_overlap - reach_i;
    contact.lever_j = half_overlap - reach_j;
    if constexpr (T::Curvature)
      contact.radius_ratio =
          hertz_radius_ratio(load_as<V>(p.radius_i + at), reach_i, load_as<V>(p.radius_j + at), reach_j);
    if constexpr (T::Moves) {
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
    const Vec<V, 2> b = branch_of(c, p, at, gather_position_differences<W>(rows, p.row_i + at, p.row_j + at));
    V i[4], j[4];
    ColumnsOf<W>::load([=](int lane) { return rows + p.row_i[at + lane] + 8; }, i);
    ColumnsOf<W>::load([=](int lane) { return rows + p.row_j[at + lane] + 8; }, j);
    const EllipsePair<V> pair = {b.x, b.y, matrix_from(i[0], i[1], i[2], i[3]), matrix_from(j[0], j[1], j[2], j[3])};
    if (any_of(!shows_apart(pair, leaving_direction(pair)))) return true;
  }
  return false;
}

}  // namespace
}  // namespace rvelab
