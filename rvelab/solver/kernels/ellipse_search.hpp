// The smallest f of two ellipses (ellipse_overlap.hpp) wherever it is: branch and bound over sectors of directions, for
// the few pairs that Halley's steps leave.
//
// Within a sector rho is at least r, the sum of det M/h^3 at the largest h. f'' + f = rho >= r gives
// f >= r + n.v with v = (f - r) n0 + f' t0 from either end n0 (Sturm's comparison; circles of radius r that roll inside
// the sum of the ellipses). The larger of the two bounds is smallest at the ends or where both are equal, if it is not
// below r. A sector whose bound is not below the best f found is done, any other is halved.
#pragma once

#include "rvelab/solver/kernels/ellipse_frame.hpp"

namespace rvelab {
namespace {

/// A direction and what f is there.
struct SearchNode {
  Direction<double> n;
  EllipseGap<double> gap;
};

inline SearchNode node_at(const EllipsePair<double>& p, double x, double y) {
  const double inverse = 1.0 / square_root(x * x + y * y);
  const Direction<double> n = {x * inverse, y * inverse};
  return {n, ellipse_gap(p, n)};
}

/// det M over the cube of the largest h between two directions less than a right angle apart.
inline double least_radius(const EllipseMatrix<double>& m, double support_a, double turned_a, double support_b,
                           double turned_b) {
  const double det = m.xx * m.yy - m.xy * m.xy;
  double largest = support_a > support_b ? support_a : support_b;
  if (turned_a > 0 && turned_b < 0) {  // the long axis lies between
    const double mean = 0.5 * (m.xx + m.yy), half = 0.5 * (m.xx - m.yy);
    largest = square_root(mean + square_root(half * half + m.xy * m.xy));
  }
  return det / (largest * largest * largest);
}

/// No more than f anywhere between two directions at most 45 degrees apart, b on the left of a; -infinity: not known.
inline double sector_bound(const EllipsePair<double>& p, const SearchNode& a, const SearchNode& b) {
  const EllipseGap<double>&fa = a.gap, &fb = b.gap;
  const double r = least_radius(p.i, fa.support_i, fa.turned_i, fb.support_i, fb.turned_i) +
                   least_radius(p.j, fa.support_j, fa.turned_j, fb.support_j, fb.turned_j);
  const double above_a = fa.overlap - r, above_b = fb.overlap - r;
  const double least_end = fa.overlap < fb.overlap ? fa.overlap : fb.overlap;
  if (above_a <= 0 && fa.slope >= 0) return fa.overlap;  // rises from a on
  if (above_b <= 0 && fb.slope <= 0) return fb.overlap;
  if (above_a < 0 || above_b < 0) return -__builtin_inf();
  const double ax = above_a * a.n.x - fa.slope * a.n.y, ay = above_a * a.n.y + fa.slope * a.n.x;
  const double bx = above_b * b.n.x - fb.slope * b.n.y, by = above_b * b.n.y + fb.slope * b.n.x;
  const double dx = bx - ax, dy = by - ay, length = square_root(dx * dx + dy * dy);
  // Either bound alone, between its own end and the other: it is concave where it is above r.
  const double a_at_b = b.n.x * ax + b.n.y * ay, b_at_a = a.n.x * bx + a.n.y * by;
  double bound = -__builtin_inf();
  if (a_at_b >= 0) bound = r + (a_at_b < above_a ? a_at_b : above_a);
  if (b_at_a >= 0 && r + (b_at_a < above_b ? b_at_a : above_b) > bound)
    bound = r + (b_at_a < above_b ? b_at_a : above_b);
  if (length > 0) {
    const double crossing = (dy * ax - dx * ay) / length;
    if (crossing >= 0) {
      const double both = r + crossing < least_end ? r + crossing : least_end;
      if (both > bound) bound = both;
    }
  }
  return bound;
}

inline bool held_in(bool held, int) { return held; }
template <class Mask>
inline bool held_in(Mask held, int lane) {
  std::int64_t lanes[sizeof(Mask) / sizeof(std::int64_t)];
  std::memcpy(lanes, &held, sizeof(Mask));
  return lanes[lane] != 0;
}

/// The lowest of the places that steps downhill from a node come to.
inline SearchNode lowest_from(const EllipsePair<double>& p, SearchNode at) {
  SearchNode lowest = at;
  for (int step = 0; step < 60; ++step) {
    if (magnitude_of(at.gap.slope) <= 1e-12 * magnitude_of(at.gap.curvature)) break;
    at.n = next_direction(at.n, at.gap);
    at.gap = ellipse_gap(p, at.n);
    if (at.gap.overlap < lowest.gap.overlap) lowest = at;
  }
  return lowest;
}

/// Whether a direction lies between two others, at neither.
inline bool lies_between(Direction<double> n, const SearchNode& a, const SearchNode& b) {
  return a.n.x * n.y - a.n.y * n.x > 1e-9 && n.x * b.n.y - n.y * b.n.x > 1e-9;
}

/// The direction in which f is smallest, to 1e-13 of the supports.
inline Direction<double> search_smallest(const EllipsePair<double>& p) {
  struct Sector {
    SearchNode a, b;
  };
  constexpr int room = 64;  // sectors of 45 degrees halved down to 1e-8 leave 32 open at a time
  Sector open[room];
  // f(n) < f(-n) where n.x > 0: half of the directions are enough.
  const bool apart = p.x * p.x + p.y * p.y > 0;
  const double x = apart ? p.x : 1, y = apart ? p.y : 0, s = 0.70710678118654752440;
  SearchNode nodes[5] = {node_at(p, y, -x), node_at(p, s * (x + y), s * (y - x)), node_at(p, x, y),
                         node_at(p, s * (x - y), s * (y + x)), node_at(p, -y, x)};
  SearchNode best = nodes[0];
  for (const SearchNode& node : nodes) {
    const SearchNode found = lowest_from(p, node);
    if (found.gap.overlap < best.gap.overlap) best = found;
  }
  if (!(best.gap.overlap == best.gap.overlap)) return best.n;  // not numbers: the checks of the step say so
  int count = 0;
  for (int k = 0; k < 4; ++k) open[count++] = {nodes[k], nodes[k + 1]};
  const double close = 1e-13 * (best.gap.support_i + best.gap.support_j);
  while (count > 0) {
    const Sector sector = open[--count];
    const double width = sector.a.n.x * sector.b.n.y - sector.a.n.y * sector.b.n.x;
    if (!(width > 1e-8) || count + 2 > room) continue;
    if (sector_bound(p, sector.a, sector.b) >= best.gap.overlap - close) continue;
    const SearchNode middle = lies_between(best.n, sector.a, sector.b)
                                  ? best
                                  : node_at(p, sector.a.n.x + sector.b.n.x, sector.a.n.y + sector.b.n.y);
    if (middle.gap.overlap < best.gap.overlap - close) best = lowest_from(p, middle);
    open[count++] = {sector.a, middle};
    open[count++] = {middle, sector.b};
  }
  return best.n;
}

/// One lane of W pairs.
template <class V>
inline EllipsePair<double> pair_in_lane(const EllipsePair<V>& p, int lane) {
  constexpr int lanes = sizeof(V) / sizeof(double);
  const V columns[10] = {p.x, p.y, p.i.xx, p.i.xy, p.i.yy, p.i.sharpest, p.j.xx, p.j.xy, p.j.yy, p.j.sharpest};
  double at[10];
  for (int k = 0; k < 10; ++k) {
    double values[lanes];
    std::memcpy(values, &columns[k], sizeof(V));
    at[k] = values[lane];
  }
  return {at[0], at[1], {at[2], at[3], at[4], at[5]}, {at[6], at[7], at[8], at[9]}};
}

/// Directions of the lanes that are still open, by the search.
template <class Mask, class V>
__attribute__((noinline)) void search_lanes(Mask open, const EllipsePair<V>& p, Direction<V>& n) {
  constexpr int lanes = sizeof(V) / sizeof(double);
  double x[lanes], y[lanes];
  std::memcpy(x, &n.x, sizeof(V));
  std::memcpy(y, &n.y, sizeof(V));
  for (int lane = 0; lane < lanes; ++lane) {
    if (!held_in(open, lane)) continue;
    const Direction<double> found = search_smallest(pair_in_lane(p, lane));
    x[lane] = found.x;
    y[lane] = found.y;
  }
  std::memcpy(&n.x, x, sizeof(V));
  std::memcpy(&n.y, y, sizeof(V));
}

/// Leaves to the search what the steps did not end or what is too deep for them.
template <class Mask, class V>
__attribute__((noinline)) EllipsePlace<V> searched_where(Mask deep, const EllipsePair<V>& p, EllipsePlace<V> place) {
  search_lanes(deep, p, place.n);
  const EllipseGap<V> found = ellipse_gap(p, place.n);
  place.support_i = deep ? found.support_i : place.support_i;
  place.support_j = deep ? found.support_j : place.support_j;
  place.turned_i = deep ? found.turned_i : place.turned_i;
  place.turned_j = deep ? found.turned_j : place.turned_j;
  place.overlap = deep ? found.overlap : place.overlap;
  place.slope = deep ? found.slope : place.slope;
  return place;
}

/// Where two ellipses are closest. Where f < 0 they are apart, and n is a direction that shows it.
template <class V>
inline EllipsePlace<V> closest_place(const EllipsePair<V>& p) {
  const BranchFrame<V> frame = branch_frame(p);
  V t = first_tangent(frame), curvature = V{};
  MaskOf<V> ended = t < t;
  for (int evaluation = 1; evaluation <= halley_steps && any_of(!ended); ++evaluation)
    step_open_lanes(frame, t, curvature, ended);
  t = ended ? t : V{} + __builtin_nan("");
  EllipsePlace<V> place = place_along(frame, p.x, p.y, t);
  const MaskOf<V> settled = is_settled(place, curvature);
  if (any_of(!settled)) place = settled_place(frame, p.x, p.y, t, settled);
  const MaskOf<V> deep = !is_shallow(p, place.overlap);
  if (any_of(deep)) place = searched_where(deep, p, place);
  return place;
}

}  // namespace
}  // namespace rvelab
