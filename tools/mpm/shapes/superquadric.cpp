#include "tools/mpm/shapes/superquadric.hpp"

#include "tools/mpm/shapes/superquadric_pair.hpp"

namespace mpm {
namespace {

rvelab::Superellipsoid body_of(const Vec<3>& half, double n1, double n2) { return {half[0], half[1], half[2], n2, n1}; }
rvelab::Superellipsoid body_of(const Vec<2>& half, double n1, double) {
  const rvelab::Superellipsoid low = {half[0], half[1], half.minCoeff(), n1, 2};
  return {half[0], half[1], rvelab::bounding_radius_of(low), n1, 2};
}

}  // namespace

template <int D>
Superquadric<D>::Superquadric(const Vec<D>& half_axes, double n1, double n2)
    : half(half_axes), body(body_of(half_axes, n1, n2)), rolling_radius(rvelab::rolling_radius_of(body)) {}

template <int D>
double Superquadric<D>::gauge(const Vec<D>& x) const {
  return rvelab::gauge_of(body, x[0], x[1], D == 3 ? x[D - 1] : 0);
}

template <int D>
double Superquadric<D>::height(const Vec<D>& direction) const {
  return rvelab::support_at(form_of(*this), rvelab::own_axes, triple_of<D>(direction)).height;
}

template <int D>
Vec<D> Superquadric<D>::support(const Vec<D>& direction) const {
  return vector_of<D>(rvelab::support_at(form_of(*this), rvelab::own_axes, triple_of<D>(direction)).point);
}

template <int D>
Vec<D> Superquadric<D>::normal(const Vec<D>& x) const {
  return vector_of<D>(rvelab::normal_at(form_of(*this), rvelab::own_axes, triple_of<D>(x)));
}

/// A ball about r overlaps by its radius more than r alone, and along the same direction.
template <int D>
double Superquadric<D>::distance(const Vec<D>& r, Vec<D>& outward) const {
  const double radius = half.minCoeff();
  rvelab::SuperellipsoidForm<double> ball = {{radius, radius, radius}, 1, 1, -0.5, -0.5, radius};
  const auto contact = rvelab::contact_of({form_of(*this), ball, rvelab::own_axes, rvelab::own_axes, triple_of<D>(r)});
  outward = vector_of<D>(contact.n);
  return radius - contact.overlap;
}

template <int D>
double Superquadric<D>::volume() const {
  return D == 2 ? rvelab::superellipse_area(body.a, body.b, body.e) : rvelab::volume_of(body);
}

template <int D>
Vec<D> Superquadric<D>::inertia() const {
  if constexpr (D == 2) {
    return Vec<2>::Constant(rvelab::superellipse_inertia(body.a, body.b, body.e));
  } else {
    const auto [x, y, z] = rvelab::inertia_of(body);
    return {x, y, z};
  }
}

template struct Superquadric<2>;
template struct Superquadric<3>;

}  // namespace mpm
