// Adding superellipsoids to a specimen: each grain is a separate body.
#pragma once

#include <vector>

#include "rvelab/specimen/specimen.hpp"
#include "rvelab/superellipsoid/body.hpp"

namespace rvelab {

/// Appends a grain and its body. `position`: of its centre, cell frame; `orientation`: x y z of the shape to the cell
/// frame.
void add_superellipsoid(Specimen& specimen, const Superellipsoid& shape, const Vector3& position,
                        const Turn& orientation, std::int32_t material = 0);

/// The shape of grain g of a specimen of superellipsoids.
template <class Columns>
Superellipsoid superellipsoid_of(const Columns& of, std::size_t g) {
  return {of.half_x[g], of.half_y[g], of.half_z[g], of.exponent_xy[g], of.exponent_z[g]};
}
inline Superellipsoid superellipsoid_of(const SuperellipsoidGrain::Own& own) {
  return {own.half_x, own.half_y, own.half_z, own.exponent_xy, own.exponent_z};
}

/// m, of each grain: a ball of this radius rolls inside (superellipsoid/body.hpp).
std::vector<double> rolling_radii_of(const Grains& grains);

/// Volume and gyration (about x y z of the shape) that the body of grain g must have.
Body body_of_solid(const Grains& grains, std::size_t g);

}  // namespace rvelab
