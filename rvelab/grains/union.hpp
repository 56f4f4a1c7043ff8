// Volume, centre and inertia of a union of discs or spheres that may overlap: each point counts once.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace rvelab {

/// A disc (z = 0) or a sphere; any unit of length.
struct Ball {
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  double radius = 1;
};

/// Of a body of density 1; in the plane of one of thickness 1.
struct MassProperties {
  double volume = 0;                                  ///< in the plane the area
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();   ///< of gravity
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about it; in the plane zz alone
};

/// Exact to round-off: Green's theorem along the arcs that no other disc covers.
MassProperties union_of_discs(const std::vector<Ball>& discs);

/// By exact sections, the heights of which are those of Gauss and Legendre between the heights where the picture
/// changes: to 1e-11 of the volume (tests/grains/test_union.cpp).
MassProperties union_of_spheres(const std::vector<Ball>& spheres);

}  // namespace rvelab
