// Regions of a scene: boxes that are filled with points, and tables of grains that become points.
#pragma once

#include "tools/mpm/scene/scene.hpp"

namespace mpm {

RegionOfScene read_region(Keys& keys, std::size_t d, const std::optional<WaterOfScene>& water);

}  // namespace mpm
