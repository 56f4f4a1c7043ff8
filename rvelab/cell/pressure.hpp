// The mean pressure of a stress.
#pragma once

#include "rvelab/cell/cell.hpp"

namespace rvelab {

/// p = -tr(sigma)/d, Pa, compression positive.
inline double mean_pressure(const Matrix3& stress, int dimension) {
  return -(stress(0, 0) + stress(1, 1) + (dimension == 3 ? stress(2, 2) : 0.0)) / dimension;
}

}  // namespace rvelab
