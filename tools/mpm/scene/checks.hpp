// What a scene must be as a whole, beyond its keys one by one: names, and what lies where.
#pragma once

#include "tools/mpm/scene/scene.hpp"

namespace mpm {

/// How a region is filled with points: their number and distance along each axis; the first lies half a distance
/// inside. Of a table of grains: their number, and the side of the largest domain.
struct Filling {
  std::vector<long> count;
  std::vector<double> side;  ///< m
  long total = 1;
};
Filling filling_of(const Scene& scene, const RegionOfScene& region);

/// What a message calls a region, which has no name: region.0, as --set does.
std::string region_name(const Scene& scene, const RegionOfScene& region);

/// InputError if a name is there twice or not at all, regions overlap, have more points or nodes than allowed, waves
/// ask for more steps than a run may have, regions lie behind a plane or above the surface of a geostatic state, or a
/// watched point is far from all of them.
void check_scene(const Scene& scene, const std::string& path);

/// InputError if the points and the grid would need more memory than this machine has.
void expect_memory(const Scene& scene);

/// InputError if a load would strain a material by half at once, or more: gravity over the height of the soil and
/// pressures against its modulus of plane waves (Pa), speeds of what meets against the speed of its waves. `density` in
/// kg/m^3, of the soil.
void check_loads(const Scene& scene, const std::string& material, double modulus, double density);

}  // namespace mpm
