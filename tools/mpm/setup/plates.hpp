// Plates under pressure: what bounds them, and how heavy they are.
#pragma once

#include "tools/mpm/scene/scene.hpp"
#include "tools/mpm/step/solver.hpp"

namespace mpm {

/// Puts plates to the bodies, which stand in the order of the scene. InputError if the sides that bound one are not
/// found.
template <int D>
void place_plates(const Scene& scene, Solver<D>& solver);
/// Masses that the scene does not give: those of a cell of soil and rocks over the plate.
template <int D>
void weigh_plates(Solver<D>& solver);

}  // namespace mpm
