// The way of a mixed target, from one update of the servo to the next.
#pragma once

#include <Eigen/LU>

#include "rvelab/cell/cell.hpp"
#include "rvelab/solver/assembly/assembly.hpp"
#include "rvelab/solver/loading/mixed_target.hpp"
#include "rvelab/solver/quasi_static/constants.hpp"

namespace rvelab {

/// Strain and gradient of a mixed target so far.
struct TargetPath {
  const MixedTarget& target;
  int dimension;
  Matrix3 strain = Matrix3::Zero(), gradient = Matrix3::Zero();

  /// Adds a strain; returns the increment, relative to the present configuration, that brings the gradient there.
  Matrix3 go_on(const Matrix3& change, double fraction) {
    const Matrix3 identity = Matrix3::Identity(), from = gradient;
    strain += change;
    gradient = strain + fraction * target.spin;
    if (target.volume_ratio > 0) {
      gradient = with_volume_ratio(gradient, 1 + fraction * (target.volume_ratio - 1), dimension);
      strain = 0.5 * (gradient + gradient.transpose());
    }
    return (identity + gradient) * (identity + from).inverse() - identity;
  }
};

/// What keeps the gain of the servo regular in a gas, Pa: a hundredth of what one typical contact a grain would give,
/// from the bound `least` of the stiffness of a grain of two, N/m.
inline double gas_stiffness(const Model& model, const Cell& cell, double least) {
  const double spacing = model.dimension() == 2 ? cell.lattice(2, 2) : 2 * model.mean_radius;
  return constants::gas_over_contact * least / spacing;
}

}  // namespace rvelab
