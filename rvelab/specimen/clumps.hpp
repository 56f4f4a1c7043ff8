// Adding clumps to a specimen.
#pragma once

#include "rvelab/grains/clump.hpp"
#include "rvelab/specimen/specimen.hpp"

namespace rvelab {

/// Appends a body and its members. `radius`: m, of the disc or sphere of its volume;
/// `position`: of its centre of gravity, cell frame.
void add_clump(Specimen& specimen, const Clump& clump, double radius, const Vector3& position, const Turn& orientation,
               std::int32_t material = 0);

/// The bodies as grains, round ones at their centres with the given radii (m), for lists of grains.
Grains bodies_as_grains(const Specimen& specimen, const std::vector<double>& radius);

}  // namespace rvelab
