// A clump of spheres for a grain of any shape: spheres within its surface that touch it, few that leave little of it.
#pragma once

#include <vector>

#include "rvelab/grains/mesh.hpp"

namespace rvelab {

struct Filling {
  std::vector<Ball> spheres;  ///< in the frame and unit of the mesh, the largest first; none reaches out of it
  // How far the clump is from the grain, over the radius of the sphere of the grain's volume.
  double mean_distance = 0, largest_distance = 0;  ///< from points of the surface to the spheres
  double volume_ratio = 0;                         ///< of the union of the spheres over the grain
  double inertia_ratio = 0;                        ///< least of the ratios of the principal moments over volume^(5/3)
  double largest_inertia_ratio = 0;                ///< largest of them
};

/// With `most` spheres. Balls of the medial axis (the largest ones in the grain that touch its surface at a point:
/// Ma, Bae and Choi 2012) are chosen one after the other, each the one to which most of the surface is near that is
/// near to none yet (as Ferellec and McDowell 2010); near is the least distance for which `most` suffice. Each overlaps
/// one that was chosen before.
Filling filled(const Mesh& mesh, int most);

}  // namespace rvelab
