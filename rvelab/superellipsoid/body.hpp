// Superellipsoids as bodies: mass properties in closed form, extents, what shape analysis calls them.
//
//   V = 2 abc e1 e2 B(e1/2 + 1, e1) B(e2/2, e2/2),   e1 = 2/n, e2 = 2/e
//   I_zz/rho = abc e1 e2/2 (a^2 + b^2) B(3 e2/2, e2/2) B(e1/2, 2 e1 + 1)
//   I_xx/rho = abc e1 e2/2 [b^2 B(3 e2/2, e2/2) B(e1/2, 2 e1 + 1) + 4 c^2 B(e2/2, e2/2 + 1) B(3 e1/2, e1 + 1)]
//
// (Jaklic, Leonardis and Solina 2000, Segmentation and recovery of superquadrics.) All are convex: convexity is 1.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "rvelab/superellipsoid/support.hpp"

namespace rvelab {

/// (|x/a|^e + |y/b|^e)^(n/e) + |z/c|^n <= 1.
struct Superellipsoid {
  double a, b, c;  ///< m
  double e, n;     ///< 2 to 50
};

/// What is 0 where (u^e + v^e)^(1/e) is, of numbers that are not negative.
inline double norm_of(double u, double v, double e) {
  const double larger = std::max(u, v), smaller = std::min(u, v);
  return smaller > 0 ? larger * std::pow(1 + std::pow(smaller / larger, e), 1 / e) : larger;
}
/// Homogeneous of degree 1; 1 on the surface, less inside.
inline double gauge_of(const Superellipsoid& s, double x, double y, double z) {
  return norm_of(norm_of(std::abs(x) / s.a, std::abs(y) / s.b, s.e), std::abs(z) / s.c, s.n);
}

inline double beta_of(double x, double y) { return std::tgamma(x) * std::tgamma(y) / std::tgamma(x + y); }

/// m^3.
inline double volume_of(const Superellipsoid& s) {
  const double e1 = 2 / s.n, e2 = 2 / s.e;
  return 2 * s.a * s.b * s.c * e1 * e2 * beta_of(e1 / 2 + 1, e1) * beta_of(e2 / 2, e2 / 2);
}
/// Principal moments for a density of 1, m^5.
struct PrincipalInertia {
  double x, y, z;
};
inline PrincipalInertia inertia_of(const Superellipsoid& s) {
  const double e1 = 2 / s.n, e2 = 2 / s.e, whole = s.a * s.b * s.c * e1 * e2 / 2, aa = s.a * s.a, bb = s.b * s.b;
  const double flat = beta_of(1.5 * e2, e2 / 2) * beta_of(e1 / 2, 2 * e1 + 1);
  const double tall = 4 * s.c * s.c * beta_of(e2 / 2, e2 / 2 + 1) * beta_of(1.5 * e1, e1 + 1);
  return {whole * (bb * flat + tall), whole * (aa * flat + tall), whole * (aa + bb) * flat};
}
/// Of the figure |x/a|^e + |y/b|^e <= 1 in the plane, m^2; polar moment for a density of 1, m^4 (Dirichlet).
inline double superellipse_area(double a, double b, double e) {
  return 4 * a * b * std::pow(std::tgamma(1 + 1 / e), 2) / std::tgamma(1 + 2 / e);
}
inline double superellipse_inertia(double a, double b, double e) {
  const double each = std::tgamma(3 / e) * std::tgamma(1 / e) / (e * e * std::tgamma(1 + 4 / e));
  return 4 * a * b * each * (a * a + b * b);
}

/// Of the ball about the centre that holds it: the largest |x|, by the dual of half the exponents.
inline double bounding_radius_of(const Superellipsoid& s) {
  const auto largest = [](double u, double v, double e) { return e > 2 ? norm_of(u, v, e / (e - 2)) : std::max(u, v); };
  return std::sqrt(largest(largest(s.a * s.a, s.b * s.b, s.e), s.c * s.c, s.n));
}
/// Of the ball about the centre that lies inside.
inline double inner_radius_of(const Superellipsoid& s) { return std::min({s.a, s.b, s.c}); }
/// Of the sphere of its volume.
inline double equivalent_radius_of(const Superellipsoid& s) {
  return std::cbrt(volume_of(s) / (4 * std::numbers::pi / 3));
}
/// The shortest half axis over the longest.
inline double aspect_of(const Superellipsoid& s) { return inner_radius_of(s) / std::max({s.a, s.b, s.c}); }

/// What the support function takes; with_rolling_radius adds its last member.
inline SuperellipsoidForm<double> plain_form_of(const Superellipsoid& s) {
  return {{s.a, s.b, s.c}, 1 / (s.e - 1), 1 / (s.n - 1), -1 / s.e, -1 / s.n, 0};
}
inline constexpr SuperellipsoidAxes<double> own_axes = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

/// A ball of this radius rolls inside: by Blaschke one as small as the least radius of curvature. That is searched over
/// directions, 20 % is taken off.
inline double rolling_radius_of(const Superellipsoid& s) {
  constexpr int parts = 16;
  const SuperellipsoidForm<double> form = plain_form_of(s);
  double least = bounding_radius_of(s);
  for (int i = 0; i <= parts; ++i) {
    for (int j = 0; j <= parts; ++j) {
      const double around = std::numbers::pi / 2 * i / parts, up = std::numbers::pi / 2 * j / parts;
      const Triple<double> n = {std::cos(up) * std::cos(around), std::cos(up) * std::sin(around), std::sin(up)};
      const RadiiOfCurvature<double> radii = radii_of_curvature(support_at(form, own_axes, n));
      if (!(radii.sum < 1e100)) continue;  // flat
      const double apart = std::sqrt(std::max(0.0, radii.sum * radii.sum - 4 * radii.product));
      least = std::min(least, 2 * radii.product / (radii.sum + apart));
    }
  }
  return 0.8 * least;
}
inline SuperellipsoidForm<double> form_of(const Superellipsoid& s) {
  SuperellipsoidForm<double> form = plain_form_of(s);
  form.rolling = rolling_radius_of(s);
  return form;
}

/// m^2, to 1e-6 of it for exponents up to 8: with x = rho (a u, b v, c w), (u, v, w) on the sphere, the cone over a
/// part of it has the volume abc rho^3/3, so dA = abc rho^3/(x.n) by Gauss' rule over an octant.
inline double surface_of(const Superellipsoid& s) {
  constexpr int panels = 24;
  constexpr double nodes[4] = {-0.8611363115940526, -0.3399810435848563, 0.3399810435848563, 0.8611363115940526};
  constexpr double weights[4] = {0.3478548451374538, 0.6521451548625461, 0.6521451548625461, 0.3478548451374538};
  const SuperellipsoidForm<double> form = plain_form_of(s);
  double sum = 0;
  for (int i = 0; i < 4 * panels; ++i) {
    const double w = (i / 4 + 0.5 + 0.5 * nodes[i % 4]) / panels, around = std::sqrt(1 - w * w);
    for (int j = 0; j < 4 * panels; ++j) {
      const double angle = std::numbers::pi / 2 * (j / 4 + 0.5 + 0.5 * nodes[j % 4]) / panels;
      const Triple<double> ray = {s.a * (around * std::cos(angle)), s.b * (around * std::sin(angle)), s.c * w};
      const double rho = 1 / gauge_of(s, ray.x, ray.y, ray.z);
      const Triple<double> x = times(rho, ray), n = normal_at(form, own_axes, x);
      sum += weights[i % 4] * weights[j % 4] * rho * rho * rho / dot(x, n);
    }
  }
  return 8 * s.a * s.b * s.c * sum * (0.5 / panels) * (0.5 / panels) * std::numbers::pi / 2;
}
/// Wadell's: surface of the sphere of its volume over its own.
inline double sphericity_of(const Superellipsoid& s) {
  const double r = equivalent_radius_of(s);
  return 4 * std::numbers::pi * r * r / surface_of(s);
}

}  // namespace rvelab
