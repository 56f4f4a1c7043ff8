// The least f of two superellipsoids (overlap.hpp) wherever it is, for the few pairs that the steps over lanes leave.
//
// `lowest_from` goes downhill, each step shortened until f falls. `search_least` halves triangles of directions. The
// sum of both shapes less a ball of radius r, r the balls that roll inside them, is convex: each direction n0 gives,
// with the point X where its height is reached, a bound for all others: f(n) >= r + n.(X - r n0 - d). Over a triangle
// the least of n.v, v that vector at a corner or the mean of three, lies at a corner, where it is not negative there. A
// triangle whose bound is not below the best f found, to 1e-10 of the sizes, is done. f(n) < f(-n) where n.d > 0, so
// half of the directions are enough.
#pragma once

#include "rvelab/superellipsoid/overlap.hpp"

namespace rvelab {
namespace {

using OverlapPair = SuperellipsoidPair<double>;
using Place = OverlapAt<double>;

template <class V>
inline __attribute__((always_inline)) V size_of(const SuperellipsoidPair<V>& pair) {
  const auto largest = [](const Triple<V>& v) { return larger_of(v.x, larger_of(v.y, v.z)); };
  return largest(pair.form_i.half) + largest(pair.form_j.half);
}

/// Whether f falls no further by a step beyond rounding, nor the points of both come nearer.
template <class V>
inline __attribute__((always_inline)) auto is_least(const OverlapAt<V>& at, const OverlapStep<V>& step, V size) {
  return (dot(at.downhill, at.downhill) <= 1e-26 * size * size) |
         ((step.gain <= 1e-15 * size) & ((step.farthest <= 1e-6) | (dot(step.turn, step.turn) <= 1e-30)));
}

/// What one body says of the next direction: where its point goes by Newton's step it has this normal, and these modes.
struct NextNormal {
  Triple<double> n;
  SupportAt<double> there;
};
inline NextNormal next_normal(const SuperellipsoidForm<double>& form, const SuperellipsoidAxes<double>& axes,
                              const SupportAt<double>& at, const double* s, double sign) {
  const Triple<double> to_z = plus(at.point, sign * at.z.stiffness * s[1], at.z.along);
  const Triple<double> n = normal_at(form, axes, plus(to_z, sign * at.xy.stiffness * s[0], at.xy.along));
  return {n, support_at(form, axes, n)};
}

/// The turn by the laws of both bodies. Beside an axis of a body, where its modes change places, it knows more than
/// they.
inline Triple<double> turn_by_bodies(const OverlapPair& pair, const Place& at, const OverlapStep<double>& step) {
  const double most = 0.9 * (pair.form_i.rolling + pair.form_j.rolling), shift = at.overlap < most ? at.overlap : most;
  const NextNormal i = next_normal(pair.form_i, pair.axes_i, at.i, step.s, 1);
  const NextNormal j = next_normal(pair.form_j, pair.axes_j, at.j, step.s + 2, -1);
  return joined_turn(at.n, i.there, i.n, j.there, j.n, shift, step.plain);
}

/// Downhill to where f is least nearby.
inline Place lowest_from(const OverlapPair& pair, Place at) {
  const double size = size_of(pair), rolling = pair.form_i.rolling + pair.form_j.rolling, rounding = 1e-15 * size;
  for (int k = 0; k < 100; ++k) {
    const OverlapStep<double> step = next_step<true>(at, rolling);
    if (is_least(at, step, size)) break;
    const Triple<double> turns[3] = {step.turn, turn_by_bodies(pair, at, step), step.plain};
    const double slope = dot(at.downhill, at.downhill);
    bool moved = false;
    for (double part = 1; part > 1e-6 && !moved; part *= 0.5) {
      for (int way = 0; way < 3 && !moved; ++way) {
        const Place there = overlap_at(pair, turned_by(at.n, times(part, turns[way])));
        const double fall = at.overlap - there.overlap;
        moved = fall > larger_of(1e-4 * part * step.gain, rounding) ||
                (fall >= -rounding && dot(there.downhill, there.downhill) < 0.8 * slope);
        if (moved) at = there;
      }
      if (step.gain < 1e-14 * size) break;  // rounding is not searched
    }
    if (!moved) break;
  }
  return at;
}

/// A direction, f there, and the v that bounds f elsewhere.
struct BoundAt {
  Triple<double> n, v;
  double overlap;
};
inline BoundAt bound_at(const OverlapPair& pair, const Triple<double>& n, double rolling) {
  const Place at = overlap_at(pair, n);
  return {n, plus(times(at.overlap - rolling, n), -1.0, at.downhill), at.overlap};
}
struct DirectionTriangle {
  BoundAt corner[3];
};

/// No more than f anywhere in the triangle.
inline double least_in(const DirectionTriangle& t, double rolling) {
  const BoundAt* c = t.corner;
  const Triple<double> mean = times(1.0 / 3, plus(plus(c[0].v, 1.0, c[1].v), 1.0, c[2].v));
  double best = -1e300;
  const Triple<double>* all[4] = {&c[0].v, &c[1].v, &c[2].v, &mean};
  for (const Triple<double>* v : all) {
    const double at[3] = {dot(*v, c[0].n), dot(*v, c[1].n), dot(*v, c[2].n)};
    const double least = at[0] < at[1] ? (at[0] < at[2] ? at[0] : at[2]) : (at[1] < at[2] ? at[1] : at[2]);
    best = larger_of(best, least < 0 ? least / 0.57 : least);  // a chord of an octant is 0.577 away from the centre
  }
  return rolling + best;
}

/// The direction in which f is least. `steps`: whether places are improved by steps downhill; without, halving alone
/// leads there, to 1e-10 of the sizes. `evaluations`: of f, if they are counted.
inline Place search_least(const OverlapPair& pair, const Place& from, bool steps = true, long* evaluations = nullptr) {
  constexpr int room = 200, most = 40000;
  DirectionTriangle open[room];
  const double rolling = pair.form_i.rolling + pair.form_j.rolling, close = 1e-10 * size_of(pair);
  const double apart = dot(pair.branch, pair.branch);
  const Triple<double> line = apart > 0 ? of_length_1(pair.branch) : Triple<double>{1, 0, 0};
  const double x = magnitude_of(line.x), y = magnitude_of(line.y), z = magnitude_of(line.z);
  const Triple<double> axis = {x <= y && x <= z ? 1.0 : 0.0, y < x && y <= z ? 1.0 : 0.0, z < x && z < y ? 1.0 : 0.0};
  const Triple<double> first = of_length_1(cross(line, axis)), second = cross(line, first);
  const BoundAt nodes[5] = {bound_at(pair, line, rolling), bound_at(pair, first, rolling),
                            bound_at(pair, second, rolling), bound_at(pair, times(-1.0, first), rolling),
                            bound_at(pair, times(-1.0, second), rolling)};
  Place best = from;
  const auto improve = [&](const BoundAt& node) {
    const Place at = overlap_at(pair, node.n), found = steps ? lowest_from(pair, at) : at;
    if (found.overlap < best.overlap) best = found;
  };
  int count = 0, evaluated = 5;
  for (int k = 0; k < 5; ++k) improve(nodes[k]);
  for (int k = 0; k < 4; ++k) open[count++] = {{nodes[0], nodes[1 + k], nodes[1 + (k + 1) % 4]}};
  while (count > 0 && evaluated < most) {
    const DirectionTriangle triangle = open[--count];
    if (!(least_in(triangle, rolling) < best.overlap - close)) continue;
    int longest = 0;
    double length = -1;
    for (int k = 0; k < 3; ++k) {
      const Triple<double> edge = plus(triangle.corner[(k + 1) % 3].n, -1.0, triangle.corner[k].n);
      if (dot(edge, edge) <= length) continue;
      length = dot(edge, edge);
      longest = k;
    }
    if (length < 1e-16 || count + 2 > room) continue;
    const BoundAt &a = triangle.corner[longest], &b = triangle.corner[(longest + 1) % 3],
                  &c = triangle.corner[(longest + 2) % 3];
    const BoundAt middle = bound_at(pair, of_length_1(plus(a.n, 1.0, b.n)), rolling);
    ++evaluated;
    if (middle.overlap < best.overlap - close) improve(middle);
    open[count++] = {{a, middle, c}};
    open[count++] = {{middle, b, c}};
  }
  if (evaluations != nullptr) *evaluations = evaluated;
  return best;
}

/// Steps before a pair is left to the search.
constexpr int superellipsoid_steps = 12;

/// Whether the next step, of `part` of where the modes are at most, leads to the least: f to the third power of it, n
/// and points to the second.
template <class V>
inline __attribute__((always_inline)) auto is_near_least(const PlainStep<V>& step, double part) {
  return (step.farthest <= part) & (dot(step.plain, step.plain) <= 0.25 * (part * part));
}

/// Two grains where f is least: f, m (negative: their distance), n from i to j, the middle of the points of both, from
/// the centre of i; what the last step found, for the curvature there.
struct SuperellipsoidContact {
  double overlap;
  Triple<double> n, point;
  Place at;
};
inline SuperellipsoidContact contact_at(const OverlapPair& pair, const Place& at, const OverlapStep<double>& step) {
  const bool near = is_near_least(step, 1e-6);
  SuperellipsoidContact contact = {at.overlap - (near ? 0.5 * step.gain : 0.0),
                                   near ? turned_by(at.n, step.turn) : at.n,
                                   plus(plus(at.i.point, 1.0, at.j.point), 1.0, pair.branch), at};
  const SupportMode<double>* modes[4] = {&at.i.xy, &at.i.z, &at.j.xy, &at.j.z};
  // Where a side is flat, rounding of n moves its own point far: the points go on to where the step leads.
  for (int m = 0; m < 4; ++m)
    contact.point = plus(contact.point, (m < 2 ? 1.0 : -1.0) * (modes[m]->stiffness * step.s[m]), modes[m]->along);
  contact.point = times(0.5, contact.point);
  return contact;
}

/// Of any two, apart or not. It depends on nothing but the pair.
inline SuperellipsoidContact contact_of(const OverlapPair& pair) {
  const double size = size_of(pair), rolling = pair.form_i.rolling + pair.form_j.rolling;
  Place at = overlap_at(pair, first_direction(pair));
  if (!(at.overlap < 1e300)) at = overlap_at(pair, pair.axes_i.x);  // the centres are one
  const Place first = at;
  OverlapStep<double> step = next_step<true>(at, rolling);
  for (int k = 0; k < superellipsoid_steps && !is_near_least(step, 1e-6) && !is_least(at, step, size); ++k) {
    at = overlap_at(pair, turned_by(at.n, step.turn));
    step = next_step<true>(at, rolling);
  }
  bool found = is_near_least(step, 1e-6) || is_least(at, step, size);
  if (!found) {
    at = lowest_from(pair, at.overlap < first.overlap ? at : first);
    step = next_step<true>(at, rolling);
    found = step.gain <= 1e-14 * size;
  }
  if (!(found && at.overlap <= rolling)) {
    at = search_least(pair, at);
    step = next_step<true>(at, rolling);
  }
  return contact_at(pair, at, step);
}

}  // namespace
}  // namespace rvelab
