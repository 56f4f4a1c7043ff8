// Overlap of two ellipses. With h(n) = sqrt(n.M n) the support of an ellipse about its centre, M = a^2 e e + b^2 (1 - e
// e) for the axis e, and x the branch from i to j, f(n) = h_i + h_j - n.x is how far the two have to move apart along n
// to touch no more. The overlap is the smallest f, its direction the normal. f(n) < 0 for any n shows that they are
// apart.
//
// Along the circle of directions f'' = rho - f, rho = det M_i/h_i^3 + det M_j/h_j^3 the radii of curvature at the
// support points, and rho' = -3 (rho_i h_i'/h_i + rho_j h_j'/h_j): Halley's step costs little more than Newton's. Where
// f' = 0 and f is not above min b_i^2/a_i + min b_j^2/a_j it is the smallest of all: a circle of that radius, tangent
// from inside to the sum of both ellipses, lies within it (Blaschke's rolling theorem). What is deeper, where other
// minima may be smaller, and what does not converge is left to ellipse_search.hpp. Over lanes: ellipse_frame.hpp.
#pragma once

#include "rvelab/lanes/vectors.hpp"

namespace rvelab {
namespace {

/// Symmetric matrix M of an ellipse, m^2, and its smallest radius of curvature b^2/a, m.
template <class V>
struct EllipseMatrix {
  V xx, xy, yy, sharpest;
};

/// Two ellipses and the branch from i to j, m.
template <class V>
struct EllipsePair {
  V x, y;
  EllipseMatrix<V> i, j;
};

/// f and its derivatives at a direction n of length 1, m; t = (-n_y, n_x).
template <class V>
struct EllipseGap {
  V support_i, support_j;  ///< h
  V turned_i, turned_j;    ///< h' = t.(support point), of i from its centre; that of j lies opposite
  V overlap, slope;        ///< f, f'
  V curvature, third;      ///< f'', f'''
};

/// A direction, of length 1.
template <class V>
struct Direction {
  V x, y;
};

/// M of an ellipse whose long axis is e, from b^2 and a^2 - b^2.
template <class V>
inline __attribute__((always_inline)) EllipseMatrix<V> ellipse_matrix(Direction<V> e, V minor_squared, V difference,
                                                                      V sharpest) {
  const V x = difference * e.x, y = difference * e.y;
  return {minor_squared + x * e.x, x * e.y, minor_squared + y * e.y, sharpest};
}

template <class V>
inline __attribute__((always_inline)) V determinant(const EllipseMatrix<V>& m) {
  return m.xx * m.yy - m.xy * m.xy;
}

template <class V>
inline __attribute__((always_inline)) EllipseGap<V> ellipse_gap(const EllipsePair<V>& p, Direction<V> n) {
  const V ix = p.i.xx * n.x + p.i.xy * n.y, iy = p.i.xy * n.x + p.i.yy * n.y;
  const V jx = p.j.xx * n.x + p.j.xy * n.y, jy = p.j.xy * n.x + p.j.yy * n.y;
  EllipseGap<V> g;
  g.support_i = square_root(n.x * ix + n.y * iy);
  g.support_j = square_root(n.x * jx + n.y * jy);
  const V both = 1.0 / (g.support_i * g.support_j);
  const V inverse_i = g.support_j * both, inverse_j = g.support_i * both;
  g.turned_i = (n.x * iy - n.y * ix) * inverse_i;
  g.turned_j = (n.x * jy - n.y * jx) * inverse_j;
  g.overlap = (g.support_i + g.support_j) - (n.x * p.x + n.y * p.y);
  g.slope = (g.turned_i + g.turned_j) - (n.x * p.y - n.y * p.x);
  const V rho_i = determinant(p.i) * (inverse_i * (inverse_i * inverse_i));
  const V rho_j = determinant(p.j) * (inverse_j * (inverse_j * inverse_j));
  g.curvature = (rho_i + rho_j) - g.overlap;
  g.third = -3.0 * (rho_i * (g.turned_i * inverse_i) + rho_j * (g.turned_j * inverse_j)) - g.slope;
  return g;
}

/// Along the normal of the ellipse of M_i + M_j where the branch leaves it, m^3.
template <class V>
inline __attribute__((always_inline)) Direction<V> leaving_direction(const EllipsePair<V>& p) {
  const V xx = p.i.xx + p.j.xx, xy = p.i.xy + p.j.xy, yy = p.i.yy + p.j.yy;
  return {yy * p.x - xy * p.y, xx * p.y - xy * p.x};
}

/// Where to begin.
template <class V>
inline __attribute__((always_inline)) Direction<V> first_direction(const EllipsePair<V>& p) {
  const Direction<V> v = leaving_direction(p);
  const V inverse = 1.0 / square_root(v.x * v.x + v.y * v.y);
  return {v.x * inverse, v.y * inverse};
}

/// Whether f < 0 along a vector of any length, so far that rounding cannot hide it from is_apart.
template <class V>
inline __attribute__((always_inline)) auto shows_apart(const EllipsePair<V>& p, Direction<V> v) {
  const auto support = [&](const EllipseMatrix<V>& m) {
    return square_root(v.x * (m.xx * v.x + m.xy * v.y) + v.y * (m.xy * v.x + m.yy * v.y));
  };
  const V both = support(p.i) + support(p.j);
  return both - (v.x * p.x + v.y * p.y) < -2e-12 * both;
}

/// n turned by twice the angle whose tangent is -part/whole, |part| <= whole: of length 1 but for rounding.
template <class V>
inline __attribute__((always_inline)) Direction<V> turned_back(Direction<V> n, V part, V whole) {
  const V pp = part * part, ww = whole * whole, inverse = 1.0 / (ww + pp);
  const V cosine = (ww - pp) * inverse, sine = (part * whole + part * whole) * inverse;
  return {cosine * n.x + sine * n.y, cosine * n.y - sine * n.x};
}

/// Halley's step; where f is not convex, or the step would be long, a turn downhill of at most 28 degrees: with 53, 2 %
/// of the pairs of aspect 1/10 went to and fro.
template <class V>
inline __attribute__((always_inline)) Direction<V> next_direction(Direction<V> n, const EllipseGap<V>& g) {
  const V steep = magnitude_of(g.curvature), square = g.curvature * g.curvature;
  const V halley = (square + square) - g.slope * g.third;
  const auto near = (g.curvature > 0.0) & (halley > square);
  const V whole = near ? halley : steep + steep;
  const V part = near ? g.slope * g.curvature : g.slope;
  return turned_back(n, clamped(part, 0.25 * whole), whole);
}

/// Whether f is least around n, to a turn of 1e-10 (f itself to 1e-20).
template <class V>
inline __attribute__((always_inline)) auto is_least_nearby(const EllipseGap<V>& g) {
  return magnitude_of(g.slope) <= 1e-10 * g.curvature;
}
/// Whether f, where it is least nearby, is the least of all.
template <class V>
inline __attribute__((always_inline)) auto is_shallow(const EllipsePair<V>& p, V overlap) {
  return overlap <= p.i.sharpest + p.j.sharpest;
}

/// Evaluations of f before a pair is left to the search.
constexpr int halley_steps = 24;

}  // namespace
}  // namespace rvelab
