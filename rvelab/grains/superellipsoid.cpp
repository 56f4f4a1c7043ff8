#include "rvelab/grains/superellipsoid.hpp"

#include <algorithm>
#include <cmath>

#include "rvelab/superellipsoid/body.hpp"

namespace rvelab {

namespace {

Superellipsoid shape_of(const SuperellipsoidGrain::Own& own) {
  return {own.half_x, own.half_y, own.half_z, own.exponent_xy, own.exponent_z};
}

}  // namespace

bool SuperellipsoidGrain::allowed(const Own& own) {
  const auto [least, most] = std::minmax({own.half_x, own.half_y, own.half_z});
  const auto exponent = [](double e) { return e >= 2 && e <= largest_exponent; };
  return least > 0 && std::isfinite(most) && least >= least_aspect_ratio * (1 - 1e-12) * most &&
         exponent(own.exponent_xy) && exponent(own.exponent_z);
}

double SuperellipsoidGrain::radius(const Own& own) { return equivalent_radius_of(shape_of(own)); }

double SuperellipsoidGrain::inertia(double mass, double, const Own& own) {
  const PrincipalInertia of = inertia_of(shape_of(own));
  return mass * std::max({of.x, of.y, of.z}) / volume_of(shape_of(own));
}

Extent SuperellipsoidGrain::extent(const Own& own) {
  const Superellipsoid shape = shape_of(own);
  const double outer = bounding_radius_of(shape), inner = inner_radius_of(shape);
  const bool ellipsoid = own.exponent_xy == 2 && own.exponent_z == 2;
  return {outer, inner, ellipsoid ? outer - inner : std::sqrt(std::max(0.0, (outer - inner) * (outer + inner)))};
}

SuperellipsoidGrain::Radii SuperellipsoidGrain::radii_of_curvature(const Own& own) {
  const auto [least, most] = std::minmax({own.half_x, own.half_y, own.half_z});
  const double exponent = std::max(own.exponent_xy, own.exponent_z), tip = least * least / most;
  return {tip / (exponent - 1), exponent == 2 ? most * most / least : flattest_side * most};
}

}  // namespace rvelab
