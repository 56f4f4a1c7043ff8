// Material points of the regions of a scene.
#pragma once

#include "tools/mpm/scene/scene.hpp"
#include "tools/mpm/step/solver.hpp"

namespace mpm {

/// Adds the points of a region to the solver's: x fastest, or as its table has them. Bodies and rocks must be there;
/// what lies in rocks is left out. InputError where one would lie inside a body that is met at its surface.
template <int D>
void fill(const Scene& scene, const RegionOfScene& region, Solver<D>& solver);

}  // namespace mpm
