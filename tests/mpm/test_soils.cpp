#include "tests/catch.hpp"
#include "tools/mpm/materials/plastic.hpp"

using namespace mpm;

namespace {

constexpr double radians = 0.017453292519943295;

/// Trial stresses of all kinds, some of which lie far beyond the surface, at edges and beyond the apex.
std::vector<Mat<3>> trials() {
  std::vector<Mat<3>> list;
  for (int k = 0; k < 400; ++k) {
    const Mat<3> any =
        Mat<3>::NullaryExpr([k](long i, long j) { return std::sin(double(1 + 3 * k + 7 * i + 11 * j)); });
    list.push_back(1e5 * (0.5 * (any + any.transpose()) - 1.2 * std::cos(double(k)) * Mat<3>::Identity()));
  }
  Mat<3> axial = -5e4 * Mat<3>::Identity();
  axial(2, 2) = -9e5;
  list.push_back(axial);  // triaxial compression: an edge
  axial(2, 2) = -1e3;
  list.push_back(axial);  // extension: the other edge
  list.push_back(8e4 * Mat<3>::Identity());
  return list;
}

double coulomb(const Mat<3>& stress, double phi, double c) {
  const Eigen::SelfAdjointEigenSolver<Mat<3>> eigen(stress);
  const double s1 = eigen.eigenvalues()[2], s3 = eigen.eigenvalues()[0];
  return s1 - s3 + (s1 + s3) * std::sin(phi) - 2 * c * std::cos(phi);
}

}  // namespace

TEST_CASE("Mohr-Coulomb: what was beyond the surface comes back onto it, what was inside stays") {
  const ElasticModuli moduli{2e7, 0.3};
  const double phi = 30 * radians, c = 5e3;
  int inside = 0, back = 0;
  for (const double psi : {0.0, 10 * radians, 30 * radians}) {
    for (const auto& trial : trials()) {
      Mat<3> stress = trial;
      const double plastic = return_to_mohr_coulomb(stress, moduli, phi, c, psi);
      if (stress == trial) {
        CHECK(plastic == 0);
        CHECK(coulomb(trial, phi, c) < 1e-3);
        ++inside;
        continue;
      }
      ++back;
      CHECK(std::abs(coulomb(stress, phi, c)) < 1e-6 * trial.norm());
      // The plastic strain does work that is lost: never negative, whatever the flow.
      const Mat<3> lost = trial - stress;
      const Mat<3> strain = (lost - lost.trace() / 3 * Mat<3>::Identity()) / (2 * moduli.shear()) +
                            lost.trace() / (9 * moduli.bulk()) * Mat<3>::Identity();
      const Mat<3> shifted = stress - c / std::tan(phi) * Mat<3>::Identity();
      CHECK(strain.cwiseProduct(shifted).sum() > -1e-6 * trial.norm() * strain.norm());
      // Principal axes stay.
      CHECK((trial * stress - stress * trial).norm() < 1e-6 * trial.squaredNorm());
    }
  }
  CHECK(inside > 50);
  CHECK(back > 200);
}

TEST_CASE("Drucker-Prager: back onto the cone, whose outer one meets Mohr-Coulomb in triaxial compression") {
  const ElasticModuli moduli{2e7, 0.3};
  const double phi = 28.6 * radians;
  CHECK(cone_slope(phi, Cone::outer) == Approx(0.219).margin(5e-4));  // Li et al. (2023): values of coverage A11
  CHECK(cone_slope(phi, Cone::inner) == Approx(0.159).margin(5e-4));
  CHECK(cone_slope(phi, Cone::plane_strain) == Approx(0.154).margin(5e-4));
  for (const Cone cone : {Cone::outer, Cone::inner, Cone::plane_strain}) {
    for (const auto& trial : trials()) {
      Mat<3> stress = trial;
      const double plastic = return_to_drucker_prager(stress, moduli, phi, 2e3, 5 * radians, cone);
      const double I1 = stress.trace();
      const Mat<3> s = stress - I1 / 3 * Mat<3>::Identity();
      const double over = std::sqrt(0.5 * s.squaredNorm()) + cone_slope(phi, cone) * I1 - cone_size(phi, 2e3, cone);
      CHECK(over < 1e-6 * trial.norm());
      if (plastic > 0) CHECK(std::abs(over) < 1e-6 * trial.norm());
    }
  }
  // On the outer cone under sigma_3 = 50 kPa: sigma_1 = K_p sigma_3 + 2 c sqrt(K_p).
  const double Kp = (1 + std::sin(phi)) / (1 - std::sin(phi));
  Mat<3> limit = -5e4 * Mat<3>::Identity();
  limit(2, 2) = -(Kp * 5e4 + 2 * 2e3 * std::sqrt(Kp));
  CHECK(std::abs(coulomb(limit, phi, 2e3)) < 1e-6);
  Mat<3> nudged = limit;
  nudged(2, 2) *= 1 - 1e-9;
  CHECK(return_to_drucker_prager(nudged, moduli, phi, 2e3, 0, Cone::outer) == 0);
  nudged(2, 2) = limit(2, 2) * (1 + 1e-9);
  CHECK(return_to_drucker_prager(nudged, moduli, phi, 2e3, 0, Cone::outer) > 0);
}

TEST_CASE("hardening and softening of Li et al. (2023), eq. 43") {
  Strength strength;
  strength.law = Strength::Law::cubic_exponential;
  strength.a = 1075.64;
  strength.b = -407.93;
  strength.c = 16.39;
  strength.d = 0.32;
  strength.peak_strain = 0.022;
  strength.decay = 50;
  strength.peak = 28.6 * radians;
  strength.residual = 18.6 * radians;
  CHECK(strength.friction_at(0) == strength.residual);
  CHECK(strength.friction_at(1e-12) == Approx(0.32).epsilon(1e-6));
  CHECK(strength.friction_at(0.022) == Approx(0.4946).epsilon(1e-3));
  // The cubic is level at the peak.
  CHECK(std::abs(strength.friction_at(0.022) - strength.friction_at(0.0219)) < 2e-5);
  CHECK(strength.friction_at(0.022 + 1e-9) == Approx(strength.peak).epsilon(1e-6));
  CHECK(strength.friction_at(0.022 + 0.02) ==
        Approx(strength.residual + (strength.peak - strength.residual) / std::exp(1.0)));
}

TEST_CASE("softening ends without friction, and hardening at 89 degrees: stress stays finite under any strain") {
  const ElasticModuli moduli{2e7, 0.3};
  Strength strength;
  strength.law = Strength::Law::linear;
  strength.friction = 30 * radians;
  strength.friction_slope = -100 * radians;
  CHECK(strength.friction_at(0.1) == Approx(20 * radians));
  CHECK(strength.friction_at(0.35) == 0);
  strength.friction_slope *= -1;
  CHECK(strength.friction_at(10) == Strength::steepest);
  strength.law = Strength::Law::cubic_exponential;
  strength.d = -0.1;
  strength.peak_strain = 0.02;
  CHECK(strength.friction_at(0.01) == 0);
  for (const double cohesion : {0.0, 5e3}) {
    for (const double psi : {0.0, 20 * radians}) {
      for (const auto& trial : trials()) {
        Mat<3> stress = trial, other = trial;
        return_to_mohr_coulomb(stress, moduli, 0, cohesion, psi);
        CHECK(std::abs(coulomb(stress, 0, cohesion)) < 2 * cohesion + 1e-6 * trial.norm());
        CHECK(coulomb(stress, 0, cohesion) < 1e-6 * trial.norm());
        CHECK(stress.norm() < 10 * trial.norm());
        return_to_drucker_prager(other, moduli, 0, cohesion, psi, Cone::outer);
        CHECK(other.norm() < 10 * trial.norm());
      }
    }
  }
}

TEST_CASE("a soil sheared at constant volume reaches its strength, and takes its spin along") {
  Strength strength;
  strength.friction = 30 * radians;
  rvelab::Workers workers(1);
  Plastic<2> soil({2e7, 0.3}, strength, YieldSurface::mohr_coulomb, Cone::outer);
  Point<2> point;
  point.volume = 1;
  point.stress = -1e5 * Mat<2>::Identity();
  point.stress_zz = -1e5;
  point.gradient << 0, 1e-4, 0, 0;
  for (int k = 0; k < 2000; ++k) soil.advance(&point, 1, 0, workers);
  const double p = mean_pressure<2>(point.stress), q = deviatoric_stress<2>(point.stress);
  CHECK(q / p == Approx(std::sin(strength.friction)).epsilon(1e-6));  // no dilation: p is as it was in the plane
  CHECK(soil.measures(0).plastic_strain > 0.05);
}
