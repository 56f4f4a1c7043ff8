// Keys of plates under pressure.
#pragma once

#include "tools/mpm/scene/scene.hpp"

namespace mpm {

/// pressure_Pa or pressure_history, pressure_until_s, plate_mass_kg, area_m2 of a body; nothing without a pressure.
std::optional<PlateOfScene> read_plate(Keys& keys);
/// What a body with a pressure must be.
void check_plates(const Scene& scene, const std::string& path);

}  // namespace mpm
