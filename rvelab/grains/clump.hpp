// Clumps: discs or spheres that overlap and move as one body. Members lie in the frame of the principal axes about the
// centre of gravity of their union, in units of the radius of the disc or sphere of the same volume; that radius is the
// size of a clump in gradings.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "rvelab/grains/union.hpp"

namespace rvelab {

struct Clump {
  std::string name;
  std::vector<Ball> members;
  /// Principal moments of inertia over mass and radius squared, ascending: x is the long axis. In the plane all that
  /// about z.
  Eigen::Vector3d gyration = Eigen::Vector3d::Constant(0.4);
  Eigen::Vector3d extents = Eigen::Vector3d::Constant(2);  ///< along the principal axes, over the radius
  double outer_radius = 1;                                 ///< of the circle or sphere around the centre of gravity
};

/// From members in any frame and unit. InputError: none, radii not positive, in the plane z not 0, a sphere that no
/// other one touches (they must hang together).
Clump clump_of(const std::string& name, const std::vector<Ball>& members, int dimension);

/// A shape of the library.
struct PublishedClump {
  const char* name;
  bool plane, space;                           ///< of discs, of spheres
  const char* source;                          ///< what it is, and who used it
  std::vector<std::array<double, 4>> members;  ///< x, y, z, r
};
const std::vector<PublishedClump>& published_clumps();
/// Their names in this dimension, "pair, triangle".
std::string names_of_clumps(int dimension);
/// InputError listing the names.
Clump published_clump(const std::string& name, int dimension);

/// Members from a table of columns x, y, z, r (in the plane z may be missing), with that heading; any unit of length.
/// InputError naming the line. `where` stands before it.
std::vector<Ball> read_members(const std::string& text, const std::string& where);

}  // namespace rvelab
