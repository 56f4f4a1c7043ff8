// Keys of pore water and of loads that change with time.
#pragma once

#include "tools/mpm/scene/scene.hpp"

namespace mpm {

/// [fluid]; nothing if it is not there.
std::optional<WaterOfScene> read_water(Keys& file, const Scene& scene);
/// drained, pressure_Pa or head_m of a boundary.
WaterBoundary read_water_boundary(Keys& keys, bool with_water);
/// `grains`: of a table of grains, whose porosity dry soil has too.
void read_region_water(Keys& keys, const std::optional<WaterOfScene>& water, RegionOfScene& region, bool grains);
/// Rows of s and a value of that unit ("_Pa"), forward in time; none if the key is not there.
TimeHistory read_time_history(Keys& keys, const std::string& name, const std::string& unit);
/// loads.shaking and loads.strip.
Loads read_loads(Keys& keys, const Scene& scene);
/// What the water of a scene must be as a whole.
void check_water(const Scene& scene, const std::string& path);

}  // namespace mpm
