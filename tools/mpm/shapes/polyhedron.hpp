// Convex polyhedra: corners, flat faces of one or more triangles, and edges between faces that are not in one plane.
#pragma once

#include <vector>

#include "tools/mpm/shapes/shape.hpp"

namespace mpm {

struct Polyhedron : rvelab::Mesh {
  struct Face {
    Vec<3> normal;  ///< unit, outward
    double height;  ///< normal . x of its points, m
    std::vector<int> triangles;
  };
  struct Edge {
    int corners[2], faces[2];
  };
  std::vector<Face> faces;
  std::vector<Edge> edges;

  /// The first corner that is farthest along a direction.
  int corner_along(const Vec<3>& direction) const;
  double height(const Vec<3>& direction) const { return corner(corner_along(direction)).dot(direction); }
  const Vec<3>& corner(int k) const { return corners[std::size_t(k)]; }
  const Face& face(int k) const { return faces[std::size_t(k)]; }
  Triangle triangle(int k) const;
  double size() const;  ///< m, the longest side of the box around it
  /// RockShape::distance.
  double distance(const Vec<3>& r, Vec<3>& outward) const;
};

/// A polyhedron in its principal axes, and where they lie in the frame of its triangles.
struct Solid {
  Polyhedron form;
  double volume = 0;
  Vec<3> inertia, centre;
  Eigen::Quaterniond orientation;
};
/// RockShape::polyhedron.
Solid solid_of(const std::vector<Triangle>& triangles);

/// The point of a segment next to a point.
Vec<3> nearest_of_segment(const Vec<3>& first, const Vec<3>& second, const Vec<3>& r);

Gap<3> polyhedra_gap(const Placed<3>& a, const Polyhedron& form_a, const Placed<3>& b, const Polyhedron& form_b);
/// The normal points from the superquadric to the polyhedron.
Gap<3> block_gap(const Placed<3>& smooth, const Superquadric<3>& form, const Placed<3>& block,
                 const Polyhedron& polyhedron);

}  // namespace mpm
