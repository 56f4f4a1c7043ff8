#include "rvelab/measure/deviator.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace rvelab {
namespace {

/// Direction of the largest eigenvalue, where it lies above the next by more than round-off.
std::optional<Vector3> major_axis(const Matrix3& tensor, int dimension) {
  const Matrix3 s = deviator(tensor, dimension);
  const double size = tensor.norm(), round_off = 1e-12;
  if (!(s.norm() > round_off * size)) return {};
  if (dimension == 2) {
    const double angle = 0.5 * std::atan2(2 * s(0, 1), s(0, 0) - s(1, 1));
    return Vector3(std::cos(angle), std::sin(angle), 0);
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3> solved(s);
  if (!(solved.eigenvalues()[2] - solved.eigenvalues()[1] > round_off * size)) return {};
  return Vector3(solved.eigenvectors().col(2));
}

}  // namespace

Matrix3 identity_in(int dimension) {
  Matrix3 identity = Matrix3::Identity();
  if (dimension == 2) identity(2, 2) = 0;
  return identity;
}

Matrix3 deviator(const Matrix3& tensor, int dimension) {
  Matrix3 symmetric = 0.5 * (tensor + tensor.transpose());
  if (dimension == 2) {
    symmetric.row(2).setZero();
    symmetric.col(2).setZero();
  }
  return symmetric - symmetric.trace() / dimension * identity_in(dimension);
}

double axes_angle_deg(const Matrix3& one, const Matrix3& other, int dimension) {
  const auto a = major_axis(one, dimension), b = major_axis(other, dimension);
  if (!a || !b) return std::numeric_limits<double>::quiet_NaN();
  // By the tangent: the cosine alone loses small angles.
  const double along = std::abs(a->dot(*b)), across = a->cross(*b).norm();
  return std::atan2(across, along) * 180 / std::numbers::pi;
}

}  // namespace rvelab
