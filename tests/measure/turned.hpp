// Stiffness in a frame that is turned.
#pragma once

#include "rvelab/measure/tensor_order.hpp"

namespace rvelab::test {

/// The same response (6 x 6, components of tensor_order.hpp) in a turned frame: C'(e) = Q C(Q^T e Q) Q^T.
inline Eigen::MatrixXd turned_stiffness(const Eigen::MatrixXd& stiffness, const Matrix3& turn) {
  Eigen::MatrixXd turned(6, 6);
  for (int k = 0; k < 6; ++k) {
    const Eigen::VectorXd response = stiffness * strain_components(turn.transpose() * unit_strain(k, 3) * turn, 3);
    Matrix3 stress;
    for (int m = 0; m < 6; ++m) {
      const auto [i, j] = component_axes(m, 3);
      stress(i, j) = stress(j, i) = response[m];
    }
    turned.col(k) = stress_components(turn * stress * turn.transpose(), 3);
  }
  return turned;
}

}  // namespace rvelab::test
