// Deformations of a given change of volume.
#pragma once

#include "rvelab/cell/cell.hpp"

namespace rvelab {

/// The displacement gradient dH (dimensionless) with an isotropic stretch on top, in the plane in 2D, such that
/// det(I + dH) = `ratio` to round-off. Throws InvalidIncrement if det(I + dH) <= 0. `ratio` > 0, of order one.
Matrix3 with_volume_ratio(const Matrix3& displacement_gradient, double ratio, int dimension);

}  // namespace rvelab
