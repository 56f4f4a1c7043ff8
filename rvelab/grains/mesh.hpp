// The surface of a grain or a rock as triangles, read from STL: as scanners, tomography and CAD programs write grains.
// A library of its own (rvelab_mesh), which rvelab-mpm links too.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "rvelab/grains/union.hpp"

namespace rvelab {

using Triangle = std::array<Eigen::Vector3d, 3>;

/// A closed surface whose triangles turn counter-clockwise as seen from outside; any unit of length.
struct Mesh {
  std::vector<Eigen::Vector3d> corners;
  std::vector<std::array<int, 3>> triangles;  ///< indices into corners
};

/// Corners nearer than 1e-6 of the largest extent are one; triangles that face inward all are turned round. InputError
/// with the remedy: numbers that are not finite, a surface that is not closed, no volume. `where` stands before it.
Mesh mesh_of(const std::vector<Triangle>& triangles, const std::string& where);

/// Of the bytes of an STL file, ASCII or binary; the normals in it are not read. InputError: no STL, damaged, or as
/// mesh_of.
Mesh read_stl(const std::string& bytes, const std::string& where);

/// Of the body inside, density 1: exact, by the tetrahedra between its triangles and a point near it.
MassProperties properties_of(const Mesh& mesh, const Eigen::Vector3d& from);
/// The same, from a corner.
MassProperties properties_of(const Mesh& mesh);

/// Distance of a point to the surface; `farthest`: more than this is not looked for, and returned.
double distance_to(const Mesh& mesh, const Eigen::Vector3d& point, double farthest);

}  // namespace rvelab
