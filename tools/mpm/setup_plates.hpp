// Plates under pressure of a scene: what bounds them, and how heavy they are.
#pragma once

#include "tools/mpm/scene.hpp"

namespace mpm {

/// pressure_Pa or pressure_history, pressure_until_s, plate_mass_kg, area_m2 of a body; nothing without a pressure.
std::optional<PlateOfScene> read_plate(Keys& keys);
/// What a body with a pressure must be.
void check_plates(const Scene& scene, const std::string& path);
/// Puts plates to the bodies, which stand in the order of the scene. InputError if the sides that bound one are not
/// found.
template <int D>
void place_plates(const Scene& scene, Solver<D>& solver);
/// Masses that the scene does not give: those of a cell of soil and rocks over the plate.
template <int D>
void weigh_plates(Solver<D>& solver);

}  // namespace mpm
