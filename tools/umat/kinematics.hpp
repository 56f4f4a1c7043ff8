// Tensors in the storage of hosts of a UMAT: column-major, 11 22 33 12 13 23, engineering shear.
#pragma once

#include <Eigen/Core>
#include <array>

namespace umat {

using Matrix3 = Eigen::Matrix3d;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using RowMajor6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

/// The components of a host's element: NDI direct ones, then NSHR of shear.
struct Components {
  int direct = 3, shear = 3;
  std::array<int, 3> order{0, 1, 2};  ///< of three shear components: index of each in 12 13 23
  int size() const { return direct + shear; }
  /// Index of the k-th in 11 22 33 12 13 23.
  int place(int k) const { return k < direct ? k : 3 + (shear == 3 ? order[std::size_t(k - direct)] : k - direct); }
};

/// Symmetric part of a tensor to the host's vector.
void write_stress(const Matrix3& sigma, const Components& components, double* to);

/// Components missing in the host are zero.
Matrix3 stress_of(const double* from, const Components& components);
Matrix3 strain_of(const double* from, const Components& components);

/// (F1 - F0) F0^-1, which is F1 F0^-1 - I without its cancellation.
Matrix3 increment(const Matrix3& F0, const Matrix3& F1);

/// exp(E) - I, by its series, without cancellation.
Matrix3 exponential_increment(const Matrix3& E);

/// R of the polar decomposition F = R U.
Matrix3 rotation_of(const Matrix3& F);

/// d sigma/d eps in the order of rvelab.h (xx yy zz yz xz xy, engineering shear) in that of the host.
Matrix6 in_order_of_hosts(const RowMajor6& tangent);

/// The tangent in axes rotated by R: of R^T sigma R with respect to R^T eps R, order of the host.
Matrix6 turned(const Matrix6& tangent, const Matrix3& R);

}  // namespace umat
