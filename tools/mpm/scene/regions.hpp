// Regions of a scene: boxes that are filled with points, and tables of grains that become points.
#pragma once

#include "tools/mpm/scene/scene.hpp"

namespace mpm {

RegionOfScene read_region(Keys& keys, std::size_t d, const std::optional<WaterOfScene>& water);
/// Rows of the tables that regions name become a part of the scene, so that a run's folder is whole.
void include_grains(toml::table& file, const std::string& scene_path);

}  // namespace mpm
