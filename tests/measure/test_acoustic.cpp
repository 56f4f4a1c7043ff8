// The acoustic tensor of isotropic, cubic and plastic stiffness.
#include "rvelab/measure/acoustic.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <vector>

#include "rvelab/measure/tangent.hpp"
#include "rvelab/measure/tensor_order.hpp"
#include "tests/catch.hpp"
#include "tests/measure/crystals.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

Eigen::MatrixXd isotropic_stiffness(int dimension, double lame, double shear) {
  const int size = component_count(dimension);
  Eigen::MatrixXd c = Eigen::MatrixXd::Zero(size, size);
  c.topLeftCorner(dimension, dimension).setConstant(lame);
  for (int k = 0; k < size; ++k) c(k, k) += k < dimension ? 2 * shear : shear;
  return c;
}

/// Plane, major compression along y: C - (C P)(Q C)/(H + Q C P), with the yield direction Q of the angle phi and the
/// flow direction P of psi, strains with engineering shear.
Eigen::MatrixXd plastic_stiffness(double lame, double shear, double phi, double psi, double hardening) {
  const Eigen::MatrixXd c = isotropic_stiffness(2, lame, shear);
  const Eigen::Vector3d q(0.5 * (1 + std::sin(phi)), 0.5 * (std::sin(phi) - 1), 0);
  const Eigen::Vector3d p(0.5 * (1 + std::sin(psi)), 0.5 * (std::sin(psi) - 1), 0);
  return c - (c * p) * (q.transpose() * c) / (hardening + q.dot(c * p));
}

}  // namespace

TEST_CASE("det Q of an isotropic solid is (lambda + 2 mu) mu^(d - 1) in every direction", "[measure]") {
  const double lame = 3, shear = 2;
  for (const int d : {2, 3}) {
    const Band band = weakest_band(isotropic_stiffness(d, lame, shear));
    const double expected = (lame + 2 * shear) * std::pow(shear, d - 1);
    CHECK(band.determinant == Approx(expected).epsilon(1e-12));
    CHECK(band.mean == Approx(expected).epsilon(1e-12));
  }
  const Vector3 n = Vector3(1, -2, 3).normalized();
  const Eigen::MatrixXd q = acoustic_tensor(isotropic_stiffness(3, lame, shear), n);
  const Matrix3 expected = shear * Matrix3::Identity() + (lame + shear) * n * n.transpose();
  CHECK((q - expected).norm() < 1e-13);
}

TEST_CASE("the weakest band of a cubic solid: along the axes if it is stiff in shear, else between them", "[measure]") {
  Eigen::MatrixXd c = isotropic_stiffness(3, 3, 2);  // C44 = (C11 - C12)/2
  c.bottomRightCorner(3, 3) *= 0.1;
  const Band along = weakest_band(c);
  CHECK(along.normal.cwiseAbs().maxCoeff() == Approx(1).epsilon(1e-8));
  CHECK(along.determinant == Approx(7 * 0.2 * 0.2).epsilon(1e-10));
  c.bottomRightCorner(3, 3) *= 100;
  const Band between = weakest_band(c);
  CHECK(between.normal.cwiseAbs().maxCoeff() == Approx(std::sqrt(0.5)).epsilon(1e-5));
  // n = (1, 1, 0)/sqrt 2: C44, (C11 - C12)/2 and (C11 + C12)/2 + C44
  CHECK(between.determinant == Approx(20 * 2 * (5 + 20)).epsilon(1e-8));
}

TEST_CASE("the first band of plastic flow lies between the angles of Coulomb and Roscoe", "[measure]") {
  const double lame = 3, shear = 2;
  for (const double phi : {0.3, 0.6}) {
    for (const double psi : {-0.1, 0.0, 0.25}) {
      CAPTURE(phi, psi);
      // Where det Q vanishes first (Vardoulakis 1980): H = (a n).Q_e^-1.(b n) - Q C P at cos 2 theta.
      const double cosine = -0.5 * (std::sin(phi) + std::sin(psi)), theta = 0.5 * std::acos(cosine);
      const Vector3 n(std::sin(theta), std::cos(theta), 0);
      const auto strain = [](double angle) {
        return Eigen::Vector3d(0.5 * (1 + std::sin(angle)), 0.5 * (std::sin(angle) - 1), 0);
      };
      const Eigen::MatrixXd c = isotropic_stiffness(2, lame, shear);
      const Eigen::Vector3d a = c * strain(psi), b = c * strain(phi);
      const Eigen::Vector2d an(a[0] * n[0], a[1] * n[1]), bn(b[0] * n[0], b[1] * n[1]);
      const double hardening = an.dot(acoustic_tensor(c, n).inverse() * bn) - strain(phi).dot(a);
      const Band band = weakest_band(plastic_stiffness(lame, shear, phi, psi, hardening));
      CHECK(std::abs(band.determinant) < 1e-9 * shear * (lame + 2 * shear));
      const double angle = band_angle_deg(band, Vector3(-1, -3, 0).asDiagonal(), 2);
      CHECK(angle == Approx(theta * 180 / std::numbers::pi).margin(1e-3));
      CHECK(angle <= 45 + 0.5 * phi * 180 / std::numbers::pi);
      CHECK(angle >= 45 + 0.5 * psi * 180 / std::numbers::pi);
      CHECK(weakest_band(plastic_stiffness(lame, shear, phi, psi, hardening + 0.1)).determinant > 0);
      CHECK(weakest_band(plastic_stiffness(lame, shear, phi, psi, hardening - 0.1)).determinant < 0);
    }
  }
}

TEST_CASE("the triangular crystal has the same det Q in all directions, its C11 times its shear stiffness",
          "[measure]") {
  const Eigen::MatrixXd c = elastic_tangent(triangular(1.0, 0.9999999, 3, {1e6, 4e5, 0}));
  const Band band = weakest_band(c);
  CHECK(band.determinant == Approx(c(0, 0) * c(2, 2)).epsilon(1e-5));
  CHECK(band.mean == Approx(band.determinant).epsilon(1e-5));
}
