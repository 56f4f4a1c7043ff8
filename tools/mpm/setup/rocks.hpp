// Rocks of a scene become bodies that move.
#pragma once

#include "tools/mpm/scene/scene.hpp"
#include "tools/mpm/step/solver.hpp"

namespace mpm {

/// Nothing without rocks. InputError: two overlap, one stands in a wall, or one is too small for the points. Bodies and
/// planes must be there, points not yet.
template <int D>
void place_rocks(const Scene& scene, Solver<D>& solver);

/// Soil is not where a rock is. At the surface a point loses what of its domain lies in rocks; as a ball it goes whole
/// if more than half of its radius does, and is else given its ball. grain: m, radius of the grain that it is; 0: it is
/// none. False: nothing is left of the point. What goes is counted.
template <int D>
bool clear_of_rocks(Solver<D>& solver, Point<D>& point, double grain);

/// Once the points are there: what the user should know.
template <int D>
void finish_rocks(const Scene& scene, Solver<D>& solver, std::vector<std::string>& told);

}  // namespace mpm
