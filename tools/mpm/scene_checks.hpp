// What a scene must be as a whole, beyond its keys one by one: names, and what lies where.
#pragma once

#include "tools/mpm/scene.hpp"

namespace mpm {

/// How a region is filled with points: their number and distance along each axis; the first lies half a distance
/// inside.
struct Filling {
  std::vector<long> count;
  std::vector<double> side;  ///< m
  long total = 1;
};
Filling filling_of(const Scene& scene, const RegionOfScene& region);

/// Numbers as messages have them.
std::string text_of(double value);
std::string text_of(const std::vector<double>& values);

/// What a message calls a region, which has no name: region.0, as --set does.
std::string region_name(const Scene& scene, const RegionOfScene& region);

/// Mistake if a name is there twice or not at all, regions overlap, have more points than memory, lie behind a plane or
/// above the surface of a geostatic state, or a watched point is far from all of them.
void check_scene(const Scene& scene, const std::string& path);

}  // namespace mpm
