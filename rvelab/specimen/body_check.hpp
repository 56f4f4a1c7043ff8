// Checks of shapes beyond a radius: lengths and orientations of ellipses and superellipsoids, bodies and their members.
#pragma once

#include <vector>

#include "rvelab/specimen/checked_specimen.hpp"

namespace rvelab {

void check_bodies(const CheckedSpecimen& checked);

/// Normal of a contact of superellipsoids, from i to j; zero if they do not touch, in which case a step discards the
/// forces of the contact. `rolling`: rolling_radii_of (solids.hpp).
Vector3 normal_of_solids(const Specimen& specimen, const Contact& contact, const std::vector<double>& rolling);

}  // namespace rvelab
