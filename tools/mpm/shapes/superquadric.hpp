// Superquadrics of the plane and of space, by the formulas of rvelab/superellipsoid, which grains of the cell have too.
// A figure of the plane is the middle section of a body that is an ellipse upwards and no lower than the figure is
// wide: directions out of the plane then never part two of them sooner.
#pragma once

#include "rvelab/superellipsoid/body.hpp"
#include "tools/mpm/tensors.hpp"

namespace mpm {

template <int D>
struct Superquadric {
  Vec<D> half;                  ///< m, half axes
  rvelab::Superellipsoid body;  ///< D = 2: whose middle section it is
  double rolling_radius;        ///< m, a ball of this radius fits inside at each point of the surface

  /// D = 2: n1 alone.
  Superquadric(const Vec<D>& half_axes, double n1, double n2);

  /// Homogeneous of degree 1; 1 on the surface, less inside.
  double gauge(const Vec<D>& x) const;
  double height(const Vec<D>& direction) const;
  Vec<D> support(const Vec<D>& direction) const;
  Vec<D> normal(const Vec<D>& x) const;                           ///< at x of any gauge but 0
  Vec<D> retract(const Vec<D>& x) const { return x / gauge(x); }  ///< along the ray from the centre
  /// RockShape::distance.
  double distance(const Vec<D>& r, Vec<D>& outward) const;

  double volume() const;
  Vec<D> inertia() const;  ///< D = 2: both entries are the polar one
  double bounding_radius() const { return rvelab::bounding_radius_of(body); }
};

}  // namespace mpm
