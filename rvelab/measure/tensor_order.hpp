// The order in which tensors become columns: xx yy zz yz xz xy in 3D, xx yy xy in 2D; strains with engineering shear.
// All in the laboratory frame.
#pragma once

#include <Eigen/Core>
#include <array>
#include <utility>

#include "rvelab/cell/cell.hpp"

namespace rvelab {

/// Number of independent components of a symmetric tensor: 3 or 6.
constexpr int component_count(int dimension) { return dimension == 2 ? 3 : 6; }

/// Row and column of the k-th component.
inline std::pair<int, int> component_axes(int k, int dimension) {
  constexpr std::array<std::pair<int, int>, 6> order{{{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}};
  return dimension == 2 && k == 2 ? order[5] : order[k];
}

/// Symmetric displacement gradient of unit strain in direction k; shear: gamma = 1, both entries 1/2.
inline Matrix3 unit_strain(int k, int dimension) {
  const auto [row, column] = component_axes(k, dimension);
  Matrix3 strain = Matrix3::Zero();
  strain(row, column) += 0.5;
  strain(column, row) += 0.5;
  return strain;
}

/// Components of the symmetric part of a strain, shear as gamma.
inline Eigen::VectorXd strain_components(const Matrix3& strain, int dimension) {
  Eigen::VectorXd components(component_count(dimension));
  for (int k = 0; k < components.size(); ++k) {
    const auto [row, column] = component_axes(k, dimension);
    components[k] = row == column ? strain(row, row) : strain(row, column) + strain(column, row);
  }
  return components;
}

/// Components of the symmetric part of a stress.
inline Eigen::VectorXd stress_components(const Matrix3& stress, int dimension) {
  Eigen::VectorXd components(component_count(dimension));
  for (int k = 0; k < components.size(); ++k) {
    const auto [row, column] = component_axes(k, dimension);
    components[k] = 0.5 * (stress(row, column) + stress(column, row));
  }
  return components;
}

}  // namespace rvelab
