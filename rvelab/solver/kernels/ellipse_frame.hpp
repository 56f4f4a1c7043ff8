// The least f of two ellipses (ellipse_overlap.hpp) over lanes, in the frame of their branch x and w, x turned by a
// right angle. A direction is x + t w, t the tangent of its angle from the branch; of length 1 it is only in the end.
// Along it |x| sqrt(1 + t^2) h is H = sqrt(x.M x + 2 t w.M x + t^2 w.M w), so that each direction after the first costs
// five operations and a root an ellipse.
//
// Where f is stationary (M_i/H_i + M_j/H_j - c) (x + t w) = x, c = (H_i + H_j - x.x)/(x.x (1 + t^2)). The first
// direction is two steps of t <- -(w_i w.M_i x + w_j w.M_j x)/(w_i w.M_i w + w_j w.M_j w), without the small c, in
// which w_i : w_j = 1/H_i : 1/H_j need not be exact: a sub-step's own positions give it, to 1e-4 at aspect 0.743.
// Halley's step takes the tangent of the turn: it is exact for two circles. It leads to 1e-12, where f is evaluated; a
// slope that is left there, above 1e-10 of f'', takes one step more.
#pragma once

#include "rvelab/lanes/powers.hpp"
#include "rvelab/solver/kernels/ellipse_overlap.hpp"

namespace rvelab {
namespace {

/// x.M x, -w.M x and w.M w, m^4.
template <class V>
struct SquaredSupport {
  V along, mixed, across;
};
/// A pair in the frame of its branch.
template <class V>
struct BranchFrame {
  V squared;  ///< x.x
  SquaredSupport<V> i, j;
};

template <class V>
inline __attribute__((always_inline)) SquaredSupport<V> squared_support(const EllipseMatrix<V>& m, V x, V y,
                                                                        V squared) {
  const V mx = m.xx * x + m.xy * y, my = m.xy * x + m.yy * y;
  const V along = x * mx + y * my;
  return {along, y * mx - x * my, (m.xx + m.yy) * squared - along};
}
template <class V>
inline __attribute__((always_inline)) BranchFrame<V> branch_frame(const EllipsePair<V>& p) {
  const V squared = p.x * p.x + p.y * p.y;
  return {squared, squared_support(p.i, p.x, p.y, squared), squared_support(p.j, p.x, p.y, squared)};
}

/// H^2.
template <class V>
inline __attribute__((always_inline)) V squared_along(const SquaredSupport<V>& s, V t) {
  return s.along + t * ((t * s.across - s.mixed) - s.mixed);
}

/// Where both ellipses, weighed, are stationary.
template <class V>
inline __attribute__((always_inline)) V weighed_tangent(const BranchFrame<V>& f, V of_i, V of_j) {
  return (of_i * f.i.mixed + of_j * f.j.mixed) / (of_i * f.i.across + of_j * f.j.across);
}
/// Where to begin: 1/H_i : 1/H_j is (3 H_j^2 + H_i^2) : (3 H_i^2 + H_j^2) to 2 % along the branch of ellipses of which
/// one is twice as large, then (H_j^2 + g) : (H_i^2 + g), g = H_i H_j to 2e-3.
template <class V>
inline __attribute__((always_inline)) V first_tangent(const BranchFrame<V>& f) {
  const V both = f.i.along + f.j.along;
  const V t = weighed_tangent(f, both + (f.j.along + f.j.along), both + (f.i.along + f.i.along));
  const V square_i = squared_along(f.i, t), square_j = squared_along(f.j, t);
  const V product = square_i * square_j;
  using Bits = typename BitsOf<V>::Type;
  const V rough = same_bits<V>(0x5fe6eb50c7b537a9 - (same_bits<Bits>(product) >> 1));  // 1/sqrt(product) to 3 %
  const V mean = (product * rough) * (1.5 - 0.5 * (product * rough) * rough);
  return weighed_tangent(f, square_j + mean, square_i + mean);
}

template <class V>
using MaskOf = decltype(V{} < V{});
/// What is seen along a direction.
template <class V>
struct TangentStep {
  V next;          ///< t after Halley's step
  V curvature;     ///< f'' times |x| sqrt(1 + t^2), m^2
  MaskOf<V> near;  ///< the step is so short that it is the last, or the last but one
  MaskOf<V> apart;
};

/// Halley's step, or where f is not convex, or the step would be long, a turn downhill of at most 28 degrees, as
/// next_direction. Below, all is times |x| sqrt(1 + t^2).
template <class V>
inline __attribute__((always_inline)) TangentStep<V> tangent_step(const BranchFrame<V>& f, V t) {
  const V slant_i = t * f.i.across - f.i.mixed, slant_j = t * f.j.across - f.j.mixed;
  const V H_i = square_root(f.i.along + t * (slant_i - f.i.mixed));
  const V H_j = square_root(f.j.along + t * (slant_j - f.j.mixed));
  const V both = 1.0 / (H_i * H_j);
  const V inverse_i = H_j * both, inverse_j = H_i * both;
  const V rate_i = slant_i * inverse_i, rate_j = slant_j * inverse_j;  // dH/dt
  const V spread = 1.0 + t * t, heights = H_i + H_j, overlap = heights - f.squared;
  const V slope = spread * (rate_i + rate_j) - t * overlap;
  const V bend_i = (f.i.along * f.i.across - f.i.mixed * f.i.mixed) * (inverse_i * (inverse_i * inverse_i));
  const V bend_j = (f.j.along * f.j.across - f.j.mixed * f.j.mixed) * (inverse_j * (inverse_j * inverse_j));
  const V bend = bend_i + bend_j, squared_spread = spread * spread;
  const V curvature = squared_spread * bend - overlap;
  const V skew = squared_spread * (spread * (bend_i * (rate_i * inverse_i) + bend_j * (rate_j * inverse_j)) - t * bend);
  const V square = curvature * curvature, bent = slope * (1.5 * skew);
  V part = slope * curvature, whole = square + bent;
  const MaskOf<V> near = (magnitude_of(slope) <= 1e-3 * ((curvature < heights) ? curvature : heights)) &
                         (magnitude_of(bent) <= 3e-4 * square);
  const MaskOf<V> apart = overlap < -2e-12 * heights;
  if (any_of(!near)) {
    const MaskOf<V> halley = (curvature > 0.0) & (whole > 0.5 * square);
    whole = halley ? whole : magnitude_of(curvature);
    part = clamped(halley ? part : slope, 0.53 * whole);
  }
  const V next = (t * whole - part) / (whole + t * part);
  return {next, curvature, near, apart};
}

/// The pair seen along a direction: n of length 1, h, h', f and f'.
template <class V>
struct EllipsePlace {
  Direction<V> n;
  V support_i, support_j, turned_i, turned_j, overlap, slope;
  V inverse;  ///< 1/(|x| sqrt(1 + t^2)), 1/m
};

template <class V>
inline __attribute__((always_inline)) EllipsePlace<V> place_along(const BranchFrame<V>& f, V x, V y, V t) {
  const V slant_i = t * f.i.across - f.i.mixed, slant_j = t * f.j.across - f.j.mixed;
  const V straight_i = f.i.along - t * f.i.mixed, straight_j = f.j.along - t * f.j.mixed;
  const V H_i = square_root(straight_i + t * slant_i), H_j = square_root(straight_j + t * slant_j);
  const V length = square_root(f.squared + (t * t) * f.squared);
  const V product = H_i * H_j, both = 1.0 / (product * length), inverse = product * both;
  EllipsePlace<V> place;
  place.inverse = inverse;
  place.n = {(x - t * y) * inverse, (y + t * x) * inverse};
  place.support_i = H_i * inverse;
  place.support_j = H_j * inverse;
  place.turned_i = (slant_i - t * straight_i) * (H_j * both);
  place.turned_j = (slant_j - t * straight_j) * (H_i * both);
  const V reach = f.squared * inverse;  // n.x; n turned by a right angle has -t times that
  place.overlap = (place.support_i + place.support_j) - reach;
  place.slope = (place.turned_i + place.turned_j) + t * reach;
  return place;
}

/// Whether the place is the least, to a turn of 1e-10 by the curvature before the step that led to it, or shows that
/// the two are apart.
template <class V>
inline __attribute__((always_inline)) MaskOf<V> is_settled(const EllipsePlace<V>& place, V curvature) {
  const V of_heights = 1e-10 * (place.support_i + place.support_j), of_bend = 1e-10 * (curvature * place.inverse);
  return (magnitude_of(place.slope) <= ((of_bend < of_heights) ? of_bend : of_heights)) | (place.overlap < -of_heights);
}

/// A step of the lanes that have not ended.
template <class V>
inline __attribute__((always_inline)) void step_open_lanes(const BranchFrame<V>& f, V& t, V& curvature,
                                                           MaskOf<V>& ended) {
  const TangentStep<V> step = tangent_step(f, t);
  t = (ended | (step.apart & !step.near)) ? t : step.next;
  curvature = ended ? curvature : step.curvature;
  ended = ended | step.near | step.apart;
}

/// One step more for the lanes that the last one did not settle. What is still open has an infinite f, for the search.
template <class V>
__attribute__((noinline)) EllipsePlace<V> settled_place(const BranchFrame<V>& f, V x, V y, V t, MaskOf<V> settled) {
  const TangentStep<V> step = tangent_step(f, t);
  const V infinite = V{} + __builtin_inf();
  EllipsePlace<V> place = place_along(f, x, y, settled ? t : step.next);
  place.overlap = (settled | is_settled(place, step.curvature)) ? place.overlap : infinite;
  return place;
}

}  // namespace
}  // namespace rvelab
