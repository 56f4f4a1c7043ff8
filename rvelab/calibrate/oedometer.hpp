// Elastic constants from an oedometer test: one axis shortened, no lateral strain.
#pragma once

#include <span>

#include "rvelab/records/record.hpp"

namespace rvelab::calibrate {

/// Slopes of the normal stresses over the axial strain, and the moduli of an isotropic solid that has them, Pa. NaN
/// where there are no two records.
struct OedometerStiffness {
  double C11;   ///< d sigma_axial / d eps_axial, = K_3D + 4 G/3
  double C12;   ///< d sigma_lateral (mean) / d eps_axial, = K_3D - 2 G/3
  double G;     ///< (C11 - C12)/2
  double K_3D;  ///< C12 + 2 G/3 (Liang et al. 2023)
  double K_2D;  ///< (C11 + C12)/2 = K_3D + G/3
};

/// Least squares through the first record, over the records of one stage with |strain| <= up_to; `axis`: "x", "y", "z".
OedometerStiffness oedometer_stiffness(std::span<const records::Record> stage, const std::string& axis, int dimension,
                                       double up_to = 1e-5);

}  // namespace rvelab::calibrate
