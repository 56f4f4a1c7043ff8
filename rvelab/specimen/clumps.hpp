// Clumps put into a specimen.
#pragma once

#include "rvelab/grains/clump.hpp"
#include "rvelab/specimen/specimen.hpp"

namespace rvelab {

/// Adds a body and its members behind those that are there. `radius`: m, of the disc or sphere of its volume;
/// `position`: of its centre of gravity, cell frame.
void add_clump(Specimen& specimen, const Clump& clump, double radius, const Vector3& position, const Turn& orientation,
               std::int32_t material = 0);

/// The bodies as grains, round ones at their centres with the given radii (m): what a list of grains shows of them.
Grains bodies_as_grains(const Specimen& specimen, const std::vector<double>& radius);

}  // namespace rvelab
