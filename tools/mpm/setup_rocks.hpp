// Rocks of a scene become bodies that move.
#pragma once

#include "tools/mpm/scene.hpp"

namespace mpm {

/// Nothing without rocks. InputError: two overlap, one stands in a wall, or one is too small for the points. Bodies and
/// planes must be there, points not yet.
template <int D>
void place_rocks(const Scene& scene, Solver<D>& solver);

/// Whether a point stands where a rock does, as a ball by more than half of its radius: it is then counted as left out.
/// Else it has a ball from then on. grain: m, radius of the grain that it is; 0: it is none.
template <int D>
bool left_out(Solver<D>& solver, Point<D>& point, double grain);

/// Once the points are there: what the user should know.
template <int D>
void finish_rocks(const Scene& scene, Solver<D>& solver, std::vector<std::string>& told);

}  // namespace mpm
