// Superquadrics as the two bodies of rvelab/superellipsoid.
#pragma once

#include "rvelab/superellipsoid/search.hpp"
#include "tools/mpm/shapes/superquadric.hpp"

namespace mpm {
namespace {

template <int D>
rvelab::Triple<double> triple_of(const Vec<D>& v) {
  if constexpr (D == 2) {
    return {v[0], v[1], 0};
  } else {
    return {v[0], v[1], v[2]};
  }
}
template <int D>
Vec<D> vector_of(const rvelab::Triple<double>& v) {
  return Vec<3>(v.x, v.y, v.z).head<D>();
}
template <int D>
rvelab::SuperellipsoidForm<double> form_of(const Superquadric<D>& s) {
  auto form = rvelab::plain_form_of(s.body);
  form.rolling = s.rolling_radius;
  return form;
}
template <int D>
rvelab::SuperellipsoidAxes<double> axes_of(const Mat<D>& turn) {
  auto axes = rvelab::own_axes;
  axes.x = triple_of<D>(turn.col(0));
  axes.y = triple_of<D>(turn.col(1));
  if constexpr (D == 3) axes.z = triple_of<D>(turn.col(2));
  return axes;
}

}  // namespace
}  // namespace mpm
