#include <algorithm>
#include <cmath>

#include "tests/catch.hpp"
#include "tests/models/element_tests.hpp"
#include "tools/models/mohr_coulomb.hpp"

using namespace rvelab::models;
using namespace rvelab::test;

namespace {

constexpr double young = 5e7, poisson = 0.25, cone = 3, flow = 1.5;  // phi = 30, sin(psi) = 0.2
const MohrCoulomb line_law(30, std::asin(0.2) / 0.017453292519943295, young, poisson);

}  // namespace

TEST_CASE("Mohr-Coulomb in drained triaxial compression is two straight lines") {
  const auto result = calculate(line_law, sheared("d", Loading::drained, 1e5, 0.6, 0.05)).test;
  const double peak = 1e5 * (cone - 1), eps_peak = peak / young;
  for (std::size_t k = 0; k < result.q.size(); ++k) {
    const double eps = -std::log1p(-result.strain[k]);  // the line_law's strains are natural
    const double eps_v =
        eps < eps_peak ? (1 - 2 * poisson) * eps : (1 - 2 * poisson) * eps_peak + (1 - flow) * (eps - eps_peak);
    CHECK(result.q[k] == Approx(std::min(young * eps, peak)).epsilon(1e-4));
    CHECK(result.p[k] == Approx(1e5 + result.q[k] / 3).epsilon(1e-6));
    CHECK(-std::log1p(-result.eps_v[k]) == Approx(eps_v).margin(1e-5));
  }
}

TEST_CASE("Mohr-Coulomb fails in extension where the axial stress is the smallest") {
  const auto result = calculate(line_law, sheared("x", Loading::drained, 1e5, 0.6, -0.02)).test;
  CHECK(result.q.back() == Approx(1e5 / cone - 1e5).epsilon(1e-6));
  // d(eps_a) = -flow, 2 d(eps_r) = 1 per multiplier: d(eps_v)/d(eps_a) = 1 - 1/flow
  const std::size_t end = result.q.size() - 1;
  const double slope = (natural(result.eps_v[end]) - natural(result.eps_v[end - 1])) /
                       (natural(result.strain[end]) - natural(result.strain[end - 1]));
  CHECK(slope == Approx(1 - 1 / flow).epsilon(1e-3));
}

TEST_CASE("Mohr-Coulomb in an oedometer is elastic, and fails where its stress ratio leaves the cone") {
  const auto result = calculate(line_law, compressed("o", Loading::oedometer, 1e5, 0.6, {4e5, 1e4})).test;
  const double modulus = young * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson)), K0 = poisson / (1 - poisson);
  CHECK(result.q[10] == Approx((1 - K0) * 3e5).epsilon(1e-6));
  CHECK(-std::log1p(-result.strain[10]) == Approx(3e5 / modulus).epsilon(1e-6));
  // Unloading: sigma_r = cone sigma_a from where the elastic path meets it.
  const double sigma_r = result.p.back() - result.q.back() / 3;
  CHECK(sigma_r == Approx(cone * axial_stress(result, result.q.size() - 1)).epsilon(1e-6));
}

TEST_CASE("Mohr-Coulomb at constant volume stays at its mean stress until it fails, and dilates along the cone") {
  const auto result = calculate(line_law, sheared("u", Loading::undrained, 1e5, 0.6, 0.02)).test;
  const double M = 6 * 0.5 / (3 - 0.5);
  std::size_t failed = 0;
  for (std::size_t k = 0; k < result.q.size(); ++k) {
    if (result.q[k] < 0.999 * M * 1e5) CHECK(result.p[k] == Approx(1e5).epsilon(1e-6));
    if (result.q[k] < 1.01 * M * 1e5) continue;
    CHECK(result.q[k] == Approx(M * result.p[k]).epsilon(1e-4));
    ++failed;
  }
  CHECK(failed > 10);
}
