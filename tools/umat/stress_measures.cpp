#include "tools/umat/stress_measures.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace umat {

namespace {

constexpr int symmetric_axis[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
constexpr int any_axis[9][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 0}, {0, 2}, {2, 0}, {1, 2}, {2, 1}};
const double root_2 = std::sqrt(2.0);

/// C : d, d symmetric.
Matrix3 contracted(const Matrix6& tangent, const Matrix3& d) {
  Eigen::Matrix<double, 6, 1> strain;
  strain << d(0, 0), d(1, 1), d(2, 2), 2 * d(0, 1), 2 * d(0, 2), 2 * d(1, 2);
  const Eigen::Matrix<double, 6, 1> stress = tangent * strain;
  Matrix3 found;
  for (int k = 0; k < 6; ++k) {
    const auto [i, j] = symmetric_axis[k];
    found(i, j) = found(j, i) = stress(k);
  }
  return found;
}

/// Change of the Cauchy stress with the velocity gradient l: its symmetric part is a strain, its skew part a rotation.
Matrix3 change_of_cauchy(const Matrix6& tangent, const Matrix3& sigma, const Matrix3& l) {
  const Matrix3 spin = 0.5 * (l - l.transpose());
  return contracted(tangent, 0.5 * (l + l.transpose())) + spin * sigma - sigma * spin;
}

/// A unit of component k: of a gradient, or of a symmetric tensor as the host counts it.
Matrix3 unit_gradient(int k) {
  Matrix3 unit = Matrix3::Zero();
  unit(any_axis[k][0], any_axis[k][1]) = 1;
  return unit;
}
Matrix3 unit_strain(int k) {
  Matrix3 unit = Matrix3::Zero();
  const auto [i, j] = symmetric_axis[k];
  unit(i, j) = unit(j, i) = i == j ? 1 : 1 / root_2;
  return unit;
}

}  // namespace

Matrix3 from_cauchy(StressMeasure measure, const Matrix3& sigma, const Matrix3& F) {
  if (measure == StressMeasure::cauchy) return sigma;
  const Matrix3 inverse = F.inverse(), first = F.determinant() * sigma * inverse.transpose();
  return measure == StressMeasure::first_piola ? first : Matrix3(inverse * first);
}

Matrix3 to_cauchy(StressMeasure measure, const Matrix3& stress, const Matrix3& F) {
  if (measure == StressMeasure::cauchy) return stress;
  const Matrix3 first = measure == StressMeasure::first_piola ? stress : Matrix3(F * stress);
  return first * F.transpose() / F.determinant();
}

int symmetric_components(int dimension) { return dimension == 2 ? 4 : 6; }
int all_components(int dimension) { return dimension == 2 ? 5 : 9; }

Matrix3 symmetric_tensor(const double* from, int dimension) {
  Matrix3 tensor = Matrix3::Zero();
  for (int k = 0; k < symmetric_components(dimension); ++k) {
    const auto [i, j] = symmetric_axis[k];
    tensor(i, j) = tensor(j, i) = i == j ? from[k] : from[k] / root_2;
  }
  return tensor;
}

Matrix3 any_tensor(const double* from, int dimension) {
  Matrix3 tensor = Matrix3::Zero();
  for (int k = 0; k < all_components(dimension); ++k) tensor(any_axis[k][0], any_axis[k][1]) = from[k];
  return tensor;
}

void write_symmetric(const Matrix3& tensor, int dimension, double* to) {
  for (int k = 0; k < symmetric_components(dimension); ++k) {
    const auto [i, j] = symmetric_axis[k];
    to[k] = i == j ? tensor(i, i) : root_2 * (0.5 * (tensor(i, j) + tensor(j, i)));
  }
}

void write_any(const Matrix3& tensor, int dimension, double* to) {
  for (int k = 0; k < all_components(dimension); ++k) to[k] = tensor(any_axis[k][0], any_axis[k][1]);
}

std::vector<double> finite_strain_tangent(TangentKind kind, const Matrix6& tangent, const Matrix3& sigma,
                                          const Matrix3& F0, const Matrix3& F1, int dimension) {
  const bool by_strain = kind == TangentKind::second_piola_green_lagrange;
  const bool to_any = kind == TangentKind::first_piola_gradient;
  const int columns = by_strain ? symmetric_components(dimension) : all_components(dimension);
  const int rows = to_any ? all_components(dimension) : symmetric_components(dimension);
  const double J = F1.determinant();
  const Matrix3 inverse = F1.inverse(), to_reference = inverse.transpose();
  std::vector<double> found(std::size_t(rows * columns)), column(std::size_t(rows), 0.0);
  for (int k = 0; k < columns; ++k) {
    Matrix3 l;
    if (by_strain)
      l = to_reference * unit_strain(k) * inverse;
    else if (kind == TangentKind::kirchhoff_increment)
      l = unit_gradient(k) * F0 * inverse;
    else
      l = unit_gradient(k) * inverse;
    const Matrix3 cauchy = change_of_cauchy(tangent, sigma, l), kirchhoff = J * (cauchy + l.trace() * sigma);
    switch (kind) {
      case TangentKind::cauchy_gradient:
        write_symmetric(cauchy, dimension, column.data());
        break;
      case TangentKind::kirchhoff_increment:
        write_symmetric(kirchhoff, dimension, column.data());
        break;
      case TangentKind::first_piola_gradient:
        write_any((kirchhoff - J * sigma * l.transpose()) * to_reference, dimension, column.data());
        break;
      case TangentKind::second_piola_green_lagrange:
        write_symmetric(inverse * (kirchhoff - J * (l * sigma + sigma * l.transpose())) * to_reference, dimension,
                        column.data());
        break;
    }
    for (int row = 0; row < rows; ++row) found[std::size_t(row * columns + k)] = column[std::size_t(row)];
  }
  return found;
}

std::vector<double> small_strain_tangent(const Matrix6& tangent, int dimension) {
  const int n = symmetric_components(dimension);
  std::vector<double> found(std::size_t(n * n)), column(std::size_t(n), 0.0);
  for (int k = 0; k < n; ++k) {
    write_symmetric(contracted(tangent, unit_strain(k)), dimension, column.data());
    for (int row = 0; row < n; ++row) found[std::size_t(row * n + k)] = column[std::size_t(row)];
  }
  return found;
}

double wave_modulus(const Matrix6& tangent) {
  const Matrix6 C = 0.5 * (tangent + tangent.transpose());
  double largest = 0;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = 0; z <= 1; ++z) {
        Eigen::Vector3d n(x, y, z);
        if (n.norm() == 0) continue;
        n.normalize();
        // From n the polarisation m of the fastest wave, from m the best n: the modulus grows with each iteration.
        for (int turn = 0; turn < 20; ++turn) {
          Matrix3 acoustic;
          for (int k = 0; k < 3; ++k) {
            const Matrix3 d = 0.5 * (Matrix3::Identity().col(k) * n.transpose() + n * Matrix3::Identity().row(k));
            acoustic.col(k) = contracted(C, d) * n;
          }
          const Eigen::SelfAdjointEigenSolver<Matrix3> waves(acoustic);
          largest = std::max(largest, waves.eigenvalues()(2));
          n = waves.eigenvectors().col(2);
        }
      }
  return largest;
}

}  // namespace umat
