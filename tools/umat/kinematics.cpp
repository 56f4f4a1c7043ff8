#include "tools/umat/kinematics.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>

namespace umat {

namespace {

/// Axes of 11 22 33 12 13 23.
constexpr int axis[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

Matrix3 symmetric(const double* from, const Components& components, double shear_factor) {
  Matrix3 tensor = Matrix3::Zero();
  for (int k = 0; k < components.size(); ++k) {
    const auto [i, j] = axis[components.place(k)];
    tensor(i, j) = tensor(j, i) = (i == j ? 1 : shear_factor) * from[k];
  }
  return tensor;
}

}  // namespace

void write_stress(const Matrix3& sigma, const Components& components, double* to) {
  for (int k = 0; k < components.size(); ++k) {
    const auto [i, j] = axis[components.place(k)];
    to[k] = i == j ? sigma(i, i) : 0.5 * (sigma(i, j) + sigma(j, i));
  }
}

Matrix3 stress_of(const double* from, const Components& components) { return symmetric(from, components, 1); }
Matrix3 strain_of(const double* from, const Components& components) { return symmetric(from, components, 0.5); }

Matrix3 increment(const Matrix3& F0, const Matrix3& F1) { return (F1 - F0) * F0.inverse(); }

Matrix3 exponential_increment(const Matrix3& E) {
  // E (I + E/2 (I + E/3 (...))); 24 terms are exact to the last bits up to |E| = 1, more than any step.
  Matrix3 sum = Matrix3::Identity();
  for (int k = 24; k > 1; --k) sum = Matrix3::Identity() + E * sum / k;
  return E * sum;
}

Matrix3 rotation_of(const Matrix3& F) {
  const Eigen::JacobiSVD<Matrix3> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

Matrix6 in_order_of_hosts(const RowMajor6& tangent) {
  constexpr int from[6] = {0, 1, 2, 5, 4, 3};
  Matrix6 found;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) found(i, j) = tangent(from[i], from[j]);
  return found;
}

Matrix6 turned(const Matrix6& tangent, const Matrix3& R) {
  // Q: stresses by their components; strains with engineering shear transform by its inverse transpose (Bond 1943).
  Matrix6 Q;
  for (int k = 0; k < 6; ++k) {
    const auto [a, b] = axis[k];
    Matrix3 unit = Matrix3::Zero();
    unit(a, b) = unit(b, a) = 1;
    const Matrix3 seen = R.transpose() * unit * R;
    for (int row = 0; row < 6; ++row) Q(row, k) = seen(axis[row][0], axis[row][1]);
  }
  return Q * tangent * Q.transpose();
}

}  // namespace umat
