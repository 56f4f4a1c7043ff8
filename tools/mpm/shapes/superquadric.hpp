// Superquadrics as a norm: the surface is where gauge(x) = 1, the height of a direction is the dual norm, by Hoelder's
// inequality with exponents q = n/(n - 1). Both are norms of two numbers, in space of a norm of two and a number.
#pragma once

#include "tools/mpm/tensors.hpp"

namespace mpm {

template <int D>
struct Superquadric {
  Vec<D> half;    ///< m, half axes
  double n1, n2;  ///< D = 2: n1 alone
  /// A ball of this radius fits inside at each point of the surface: by Blaschke one as small as the least radius of
  /// curvature does. It is searched over directions, 20 % is taken off.
  double rolling_radius;

  Superquadric(const Vec<D>& half_axes, double first, double second);

  /// Homogeneous of degree 1; 1 on the surface, less inside.
  double gauge(const Vec<D>& x) const;
  double height(const Vec<D>& direction) const;
  Vec<D> support(const Vec<D>& direction) const;
  /// At a point of the surface: the unit normal, and how it turns along the surface, d normal = curvature d x.
  void bend(const Vec<D>& x, Vec<D>& normal, Mat<D>& curvature) const;
  Vec<D> normal(const Vec<D>& x) const;                           ///< at x of any gauge but 0
  Vec<D> retract(const Vec<D>& x) const { return x / gauge(x); }  ///< along the ray from the centre
  /// RockShape::distance.
  double distance(const Vec<D>& r, Vec<D>& outward) const;

  double volume() const;
  Vec<D> inertia() const;  ///< D = 2: both entries are the polar one
  double bounding_radius() const;

 private:
  Vec<D> foot_from(Vec<D> x, const Vec<D>& r) const;
  Vec<D> exit(Vec<D> r, int axis) const;
};

/// D - 1 unit vectors across a unit vector.
template <int D>
Eigen::Matrix<double, D, D - 1> across(const Vec<D>& n);

/// Q^-1 F for a symmetric Q, whose eigenvalues are taken as positive: a step to a minimum, never to a saddle.
template <int D>
Eigen::Matrix<double, D - 1, 1> descent(const Eigen::Matrix<double, D - 1, D - 1>& Q,
                                        const Eigen::Matrix<double, D - 1, 1>& F);

}  // namespace mpm
