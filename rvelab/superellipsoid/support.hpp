// The support function of a superellipsoid, its points and its curvature, over lanes.
//
//   (|x/a|^e + |y/b|^e)^(n/e) + |z/c|^n <= 1,   e, n >= 2
//   h(m) = N_z(N_xy(a |m_x|, b |m_y|), c |m_z|),   N(u, v) = (u^q + v^q)^(1/q),   q = e/(e - 1) or n/(n - 1)
//
// h, the largest x.m of its points x, is the dual norm (Hoelder), and its gradient is the point where it is reached. Of
// the larger, M, and the smaller, m, of u and v let r = m/M, t = r^(q - 1) and g = (1 + r t)^(-1/e): then N = M (1 + r
// t) g, dN/dM = g, dN/dm = g t, and the second derivative is k w w with w = (v, -u), k = (q - 1) g^2 t/(u v N). So two
// powers a norm give all, and the second derivative of h, the radii of curvature across m, is a sum of two products, a
// mode for each norm. k has no bound where m is 0: there the surface is flat (e > 2).
#pragma once

#include "rvelab/lanes/powers.hpp"

namespace rvelab {
namespace {

/// Half axes, m, and what the powers take of the exponents e (of x and y) and n (of both and z).
template <class V>
struct SuperellipsoidForm {
  Triple<V> half;
  V share_xy, share_z;  ///< q - 1 = 1/(e - 1)
  V root_xy, root_z;    ///< -1/e
  V rolling;            ///< m, a ball of this radius rolls inside; no radius of curvature is smaller
};

/// Its place: the axes of its frame in the world's.
template <class V>
struct SuperellipsoidAxes {
  Triple<V> x, y, z;
};
template <class V>
inline __attribute__((always_inline)) Triple<V> in_frame(const SuperellipsoidAxes<V>& axes, const Triple<V>& v) {
  return {dot(axes.x, v), dot(axes.y, v), dot(axes.z, v)};
}
template <class V>
inline __attribute__((always_inline)) Triple<V> in_world(const SuperellipsoidAxes<V>& axes, const Triple<V>& v) {
  return plus(plus(times(v.x, axes.x), v.y, axes.y), v.z, axes.z);
}

/// A mode k U U of the second derivative of h. `growth` s, s = U.dm, is how much r grows relative to itself.
template <class V>
struct SupportMode {
  V stiffness;      ///< k
  Triple<V> along;  ///< U, across m
  V growth;
  V share;  ///< q - 1
};

/// At a unit vector m: h, its point about the centre, modes; all in the world's axes.
template <class V>
struct SupportAt {
  V height;
  Triple<V> point;
  SupportMode<V> xy, z;
};

template <class V>
inline __attribute__((always_inline)) V larger_of(V a, V b) {
  return a > b ? a : b;
}

/// N of u, v > 0.
template <class V>
struct DualNorm {
  V value, by_u, by_v;
  V stiffness, growth;  ///< k; d ln r = growth (v du - u dv)
};
template <class V>
inline __attribute__((always_inline)) DualNorm<V> dual_norm(V u, V v, V share, V root) {
  const auto first = u >= v;
  const V larger = first ? u : v, smaller = first ? v : u;
  const V products = 1.0 / (u * v), ratio = smaller * smaller * products;
  const V t = power_of(ratio, share), sum = 1.0 + ratio * t, g = power_of(sum, root), gt = g * t;
  DualNorm<V> norm;
  norm.value = larger * (sum * g);
  norm.by_u = first ? g : gt;
  norm.by_v = first ? gt : g;
  norm.growth = first ? -products : products;
  norm.stiffness = share * (g * gt) * products / norm.value;
  return norm;
}

/// v with the signs of `of`, v >= 0.
template <class V>
inline __attribute__((always_inline)) V with_sign(V v, V of) {
  return (of < 0.0) ? -v : v;
}

/// `at` is filled where it stands: what is so long is copied else.
template <class V>
inline __attribute__((always_inline)) void support_at(const SuperellipsoidForm<V>& form,
                                                      const SuperellipsoidAxes<V>& axes, const Triple<V>& m,
                                                      SupportAt<V>& at) {
  const Triple<V> own = in_frame(axes, m);
  // Where an axis is across m, modes have no bound or, at the poles, no direction: there they are those of 1e-60 beside
  // it.
  const Triple<V> all = {form.half.x * magnitude_of(own.x), form.half.y * magnitude_of(own.y),
                         form.half.z * magnitude_of(own.z)};
  const V least = 1e-60 * larger_of(all.x, larger_of(all.y, all.z)), zero = V{};
  const V px = larger_of(all.x, least), py = larger_of(all.y, least), pz = larger_of(all.z, least);
  const DualNorm<V> xy = dual_norm(px, py, form.share_xy, form.root_xy);
  const DualNorm<V> z = dual_norm(xy.value, pz, form.share_z, form.root_z);
  const Triple<V> signed_half = {with_sign(form.half.x, own.x), with_sign(form.half.y, own.y),
                                 with_sign(form.half.z, own.z)};
  at.height = z.value;
  const V sx = signed_half.x * xy.by_u, sy = signed_half.y * xy.by_v;
  at.point = in_world(axes, Triple<V>{(all.x > 0.0) ? sx * z.by_u : zero, (all.y > 0.0) ? sy * z.by_u : zero,
                                      (all.z > 0.0) ? signed_half.z * z.by_v : zero});
  at.xy = {xy.stiffness * z.by_u, in_world(axes, Triple<V>{signed_half.x * py, -(signed_half.y * px), V{}}), xy.growth,
           form.share_xy};
  at.z = {z.stiffness, in_world(axes, Triple<V>{pz * sx, pz * sy, -(xy.value * signed_half.z)}), z.growth,
          form.share_z};
}
template <class V>
inline __attribute__((always_inline)) SupportAt<V> support_at(const SuperellipsoidForm<V>& form,
                                                              const SuperellipsoidAxes<V>& axes, const Triple<V>& m) {
  SupportAt<V> at;
  support_at(form, axes, m, at);
  return at;
}

template <class V>
inline __attribute__((always_inline)) Triple<V> of_length_1(const Triple<V>& v) {
  return times((V{} + 1.0) / square_root(dot(v, v)), v);
}

/// The outward normal where the ray from the centre along r leaves: along the gradient of the norm (|x/a|^e +
/// ...)^(1/n), whose powers are those of the support function the other way round.
template <class V>
inline __attribute__((always_inline)) Triple<V> normal_at(const SuperellipsoidForm<V>& form,
                                                          const SuperellipsoidAxes<V>& axes, const Triple<V>& r) {
  const V one = V{} + 1.0, least = V{} + 1e-280;
  const auto small_power = [&](V base, V exponent) {  // base to 1
    return exp2_of(larger_of(exponent * log2_of(larger_of(base, least)), V{} - 900.0));
  };
  const Triple<V> own = in_frame(axes, r);
  const V x = magnitude_of(own.x) / form.half.x, y = magnitude_of(own.y) / form.half.y;
  const V z = magnitude_of(own.z) / form.half.z;
  const auto first = x > y;
  const V larger = first ? x : y, smaller = first ? y : x, e1 = one / form.share_xy, n1 = one / form.share_z;
  const V ratio = smaller / ((larger > 0.0) ? larger : one);
  const V t = small_power(ratio, e1), sum = 1.0 + ratio * t;
  const V root = power_of(sum, -form.root_xy), level = larger * root, g = root / sum;
  const V most = larger_of(level, z), level_share = small_power(level / most, n1), share_z = small_power(z / most, n1);
  const Triple<V> gradient = {level_share * (first ? g : g * t) / form.half.x,
                              level_share * (first ? g * t : g) / form.half.y, share_z / form.half.z};
  return of_length_1(in_world(
      axes, Triple<V>{with_sign(gradient.x, own.x), with_sign(gradient.y, own.y), with_sign(gradient.z, own.z)}));
}

/// Trace and determinant of the radii of curvature across a direction, m and m^2.
template <class V>
struct RadiiOfCurvature {
  V sum, product;
};
template <class V>
inline __attribute__((always_inline)) RadiiOfCurvature<V> radii_of_curvature(const SupportAt<V>& at) {
  const Triple<V> area = cross(at.xy.along, at.z.along);
  return {at.xy.stiffness * dot(at.xy.along, at.xy.along) + at.z.stiffness * dot(at.z.along, at.z.along),
          at.xy.stiffness * (at.z.stiffness * dot(area, area))};
}

/// A side whose radius of curvature is more than this many times the longest half axis is flat, and counts as that:
/// flat sides have none. That of an ellipsoid is never more.
constexpr double flattest_side = 10;
template <class V>
inline __attribute__((always_inline)) V largest_radius(const Triple<V>& half) {
  return flattest_side * larger_of(half.x, larger_of(half.y, half.z));
}

/// Hertz's radius of a contact from the curvatures of both bodies there, m: R* = 1/sqrt(k' k''), k the principal values
/// of the sum of their curvature tensors (Johnson 1985, Contact Mechanics, 4.2). With C the tensors of the radii,
/// det(C_i^-1 + C_j^-1) = det(C_i + C_j)/(det C_i det C_j). `most`: largest_radius of either.
template <class V>
inline __attribute__((always_inline)) V hertz_radius(const SupportAt<V>& i, const SupportAt<V>& j, V most_i, V most_j) {
  const SupportMode<V>* modes[4] = {&i.xy, &i.z, &j.xy, &j.z};
  V k[4];
  for (int m = 0; m < 4; ++m) {
    const V squared = dot(modes[m]->along, modes[m]->along), most = m < 2 ? most_i : most_j;
    k[m] = (modes[m]->stiffness * squared < most) ? modes[m]->stiffness : most / squared;
  }
  const auto product = [&](int m, int l) {
    const Triple<V> area = cross(modes[m]->along, modes[l]->along);
    return (k[m] * dot(area, area)) * k[l];
  };
  const V own_i = product(0, 1), own_j = product(2, 3);
  const V both = (own_i + own_j) + ((product(0, 2) + product(0, 3)) + (product(1, 2) + product(1, 3)));
  return square_root(own_i * own_j / both);
}

}  // namespace
}  // namespace rvelab
