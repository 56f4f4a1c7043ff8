#include "rvelab/measure/acoustic.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "rvelab/measure/deviator.hpp"
#include "rvelab/measure/tensor_order.hpp"

namespace rvelab {
namespace {

int dimension_of_stiffness(const Eigen::MatrixXd& stiffness) { return stiffness.rows() == 3 ? 2 : 3; }

double determinant(const Eigen::MatrixXd& stiffness, const Vector3& normal) {
  return acoustic_tensor(stiffness, normal).determinant();
}

/// Directions over the half circle or, each for the same angle of space, over the half sphere.
std::vector<Vector3> directions(int dimension) {
  std::vector<Vector3> all;
  const double pi = std::numbers::pi;
  const int count = dimension == 2 ? 180 : 2000;
  for (int k = 0; k < count; ++k) {
    const double z = (k + 0.5) / count, r = std::sqrt(1 - z * z), turn = k * pi * (3 - std::sqrt(5.0));
    const double angle = pi * k / count;
    all.push_back(dimension == 2 ? Vector3(std::cos(angle), std::sin(angle), 0)
                                 : Vector3(r * std::cos(turn), r * std::sin(turn), z));
  }
  return all;
}

/// Descent of a normal by steps in each direction, halved when no step reduces det Q.
void descend(const Eigen::MatrixXd& stiffness, Band& band) {
  const int dimension = dimension_of_stiffness(stiffness);
  for (double step = 0.05; step > 1e-10;) {
    const Vector3 one = dimension == 2 ? Vector3(-band.normal[1], band.normal[0], 0) : band.normal.unitOrthogonal();
    const Vector3 other = dimension == 2 ? Vector3(-one) : Vector3(band.normal.cross(one));
    Band best = band;
    for (const Vector3& way : {one, Vector3(-one), other, Vector3(-other)}) {
      const Vector3 normal = (band.normal + step * way).normalized();
      const double found = determinant(stiffness, normal);
      if (found < best.determinant) best.determinant = found, best.normal = normal;
    }
    if (best.determinant == band.determinant) step *= 0.5;
    band = best;
  }
}

}  // namespace

Eigen::MatrixXd acoustic_tensor(const Eigen::MatrixXd& stiffness, const Vector3& normal) {
  const int dimension = dimension_of_stiffness(stiffness);
  // Column of the components: dyad n (x) e_k as an engineering strain; row: stress times n.
  Eigen::MatrixXd strains = Eigen::MatrixXd::Zero(stiffness.rows(), dimension);
  for (int c = 0; c < stiffness.rows(); ++c) {
    const auto [i, j] = component_axes(c, dimension);
    strains(c, i) += normal[j];
    if (i != j) strains(c, j) += normal[i];
  }
  return strains.transpose() * stiffness * strains;
}

Band weakest_band(const Eigen::MatrixXd& stiffness) {
  Band band;
  const auto all = directions(dimension_of_stiffness(stiffness));
  for (const Vector3& normal : all) {
    const double found = determinant(stiffness, normal);
    band.mean += found / double(all.size());
    if (&normal == &all.front() || found < band.determinant) band.determinant = found, band.normal = normal;
  }
  descend(stiffness, band);
  for (int k = 0; k < 3; ++k) {
    if (std::abs(band.normal[k]) < 1e-9) continue;
    if (band.normal[k] < 0) band.normal = Vector3::Zero() - band.normal;
    break;
  }
  return band;
}

double band_angle_deg(const Band& band, const Matrix3& stress, int dimension) {
  return axes_angle_deg(band.normal * band.normal.transpose(), -stress, dimension);
}

}  // namespace rvelab
