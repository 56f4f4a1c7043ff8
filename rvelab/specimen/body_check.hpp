// What has more than a radius: lengths and orientations of ellipses and superellipsoids, bodies and their members.
#pragma once

#include <vector>

#include "rvelab/specimen/checked_specimen.hpp"

namespace rvelab {

void check_bodies(const CheckedSpecimen& checked);

/// Normal of a contact of superellipsoids, from i to j; zero where they do not touch, and a step forgets what they
/// hold. `rolling`: rolling_radii_of (solids.hpp).
Vector3 normal_of_solids(const Specimen& specimen, const Contact& contact, const std::vector<double>& rolling);

}  // namespace rvelab
