#include "tools/mpm/shapes/shape.hpp"

#include <numbers>

#include "tools/mpm/error.hpp"
#include "tools/mpm/shapes/polyhedron.hpp"
#include "tools/mpm/shapes/superquadric.hpp"

namespace mpm {
namespace {

void check_positive(double value, const char* what) {
  if (value > 0 && value < 1e300) return;
  throw InputError(std::string("a rock's ") + what + " is " + in_words(value) + " m; it must be positive");
}

void check_exponent(double n) {
  if (n >= 2 && n <= 50) return;
  throw InputError("a superquadric's blockiness is " + in_words(n) + "; it must lie between 2 (an ellipsoid) and 50");
}

}  // namespace

template <int D>
RockShape<D> RockShape<D>::sphere(double radius) {
  check_positive(radius, "radius");
  RockShape shape;
  shape.form_ = radius;
  shape.volume_ = D == 2 ? std::numbers::pi * radius * radius : 4 * std::numbers::pi / 3 * std::pow(radius, 3);
  shape.inertia_.setConstant((D == 2 ? 0.5 : 0.4) * shape.volume_ * radius * radius);
  shape.bounding_radius_ = shape.inner_radius_ = radius;
  return shape;
}

template <int D>
RockShape<D> RockShape<D>::superquadric(const Vec<D>& half_axes, double n1, double n2) {
  for (int i = 0; i < D; ++i) check_positive(half_axes[i], "half axis");
  check_exponent(n1);
  if (D == 3) check_exponent(n2);
  const auto form = std::make_shared<Superquadric<D>>(half_axes, n1, n2);
  RockShape shape;
  shape.form_ = form;
  shape.volume_ = form->volume();
  shape.inertia_ = form->inertia().template tail<Spin<D>::RowsAtCompileTime>();
  shape.bounding_radius_ = form->bounding_radius();
  shape.inner_radius_ = half_axes.minCoeff();  // exponents of 2 or more: no point of the surface is nearer
  return shape;
}

template <int D>
RockShape<D> RockShape<D>::polyhedron(const std::vector<Triangle>& triangles, Vec<3>* centre,
                                      Eigen::Quaterniond* orientation) requires(D == 3) {
  const Solid solid = solid_of(triangles);
  RockShape shape;
  shape.form_ = std::make_shared<const Polyhedron>(solid.form);
  shape.volume_ = solid.volume;
  shape.inertia_ = solid.inertia;
  shape.inner_radius_ = 1e300;
  for (const auto& corner : solid.form.corners)
    shape.bounding_radius_ = std::max(shape.bounding_radius_, corner.norm());
  for (const auto& face : solid.form.faces) shape.inner_radius_ = std::min(shape.inner_radius_, face.height);
  if (centre != nullptr) *centre = solid.centre;
  if (orientation != nullptr) *orientation = solid.orientation;
  return shape;
}

template <int D>
double RockShape<D>::equivalent_radius() const {
  return D == 2 ? std::sqrt(volume_ / std::numbers::pi) : std::cbrt(volume_ / (4 * std::numbers::pi / 3));
}

template <int D>
double RockShape<D>::height(const Vec<D>& direction) const {
  if (const double* radius = std::get_if<0>(&form_)) return *radius;
  if (const auto* form = std::get_if<1>(&form_)) return (*form)->height(direction);
  if constexpr (D == 3) return std::get<2>(form_)->height(direction);
  return 0;
}

template <int D>
Vec<D> RockShape<D>::support(const Vec<D>& direction) const {
  if (const double* radius = std::get_if<0>(&form_)) return *radius * direction;
  if (const auto* form = std::get_if<1>(&form_)) return (*form)->support(direction);
  if constexpr (D == 3) {
    const auto& polyhedron = *std::get<2>(form_);
    return polyhedron.corner(polyhedron.corner_along(direction));
  }
  return direction;
}

template <int D>
double RockShape<D>::distance(const Vec<D>& r, Vec<D>& outward) const {
  if (const double* radius = std::get_if<0>(&form_)) {
    const double length = r.norm();
    outward = length > 0 ? Vec<D>(r / length) : Vec<D>::Unit(0);
    return length - *radius;
  }
  if (const auto* form = std::get_if<1>(&form_)) return (*form)->distance(r, outward);
  if constexpr (D == 3) return std::get<2>(form_)->distance(r, outward);
  return 0;
}

template class RockShape<2>;
template class RockShape<3>;

}  // namespace mpm
