#include <algorithm>
#include <cmath>

#include "tests/catch.hpp"
#include "tests/models/element_tests.hpp"
#include "tools/models/hardening_soil_small.hpp"

using namespace rvelab::models;
using namespace rvelab::test;

namespace {

const HardeningSoilParameters hardening_sand{38, 8, 3e7, 3e7, 9e7, 0.5, 0.2, 0.4, 0.9, 1.2e8, 1.5e-4};

/// Without small-strain stiffness, dilation and cap: what the hyperbola is derived for.
HardeningSoilSmall plain(double psi = 0) {
  HardeningSoilParameters given = hardening_sand;
  given.G0 = 0, given.psi_deg = psi;
  return HardeningSoilSmall(given, false);
}

}  // namespace

TEST_CASE("Hardening Soil follows the hyperbola of Schanz, Vermeer and Bonnier at three pressures") {
  const double s = std::sin(38 * 0.017453292519943295);
  for (const double p0 : {5e4, 1e5, 4e5}) {
    const auto result = calculate(plain(), sheared("d", Loading::drained, p0, 0.6, 0.2, 80)).test;
    const double scale = std::sqrt(p0 / 1e5), E_i = 2 * 3e7 / (2 - 0.9) * scale, E_ur = 9e7 * scale;
    const double q_f = p0 * 2 * s / (1 - s), q_a = q_f / 0.9;
    std::size_t rows = 0;
    for (std::size_t k = 1; k < result.q.size(); ++k) {
      const double q = result.q[k];
      if (q > 0.999 * q_f) break;
      CHECK(natural(result.strain[k]) == Approx(q / (E_i * (1 - q / q_a))).epsilon(2e-3));
      CHECK(natural(result.eps_v[k]) == Approx(0.6 * q / E_ur).epsilon(2e-3));  // elastic: 1 - 2 nu_ur
      ++rows;
    }
    CHECK(rows > 20);
    CHECK(result.q.back() == Approx(q_f).epsilon(1e-6));
  }
}

TEST_CASE("Hardening Soil has E50 as its secant at half of the strength, E_ur in unloading and reloading") {
  const double s = std::sin(38 * 0.017453292519943295), q_f = 1e5 * 2 * s / (1 - s);
  const double eps_half = 0.5 * q_f / 3e7;
  ElementTest test;
  test.name = "cycle", test.loading = Loading::drained, test.p0 = 1e5, test.e0 = 0.6;
  for (const double eps : {0.0, eps_half, eps_half - 5e-4, eps_half - 1e-3, eps_half - 5e-4})
    add_row(test, -std::expm1(-eps), 1e5);
  const auto result = calculate(plain(), test).test;
  CHECK(result.q[1] == Approx(0.5 * q_f).epsilon(1e-3));
  CHECK((result.q[1] - result.q[3]) / 1e-3 == Approx(9e7).epsilon(1e-4));
  CHECK((result.q[4] - result.q[3]) / 5e-4 == Approx(9e7).epsilon(1e-4));
}

TEST_CASE("Hardening Soil dilates at failure by its dilation angle") {
  const auto result = calculate(plain(8), sheared("d", Loading::drained, 1e5, 0.6, 0.25, 80)).test;
  const std::size_t end = result.q.size() - 1;
  const double slope = (natural(result.eps_v[end]) - natural(result.eps_v[end - 1])) /
                       (natural(result.strain[end]) - natural(result.strain[end - 1]));
  const double s = std::sin(8 * 0.017453292519943295);
  CHECK(slope == Approx(1 - (1 + s) / (1 - s)).epsilon(1e-3));
}

TEST_CASE("Hardening Soil has K0nc and Eoed_ref in first oedometric loading") {
  const HardeningSoilSmall law(hardening_sand);
  REQUIRE(law.cap_exists());
  const auto result = calculate(law, compressed("o", Loading::oedometer, 100, 0.6, {9.9e4, 1.01e5, 4e5, 3.9e5})).test;
  const auto at = [&](std::size_t k) { return axial_stress(result, k); };
  const auto modulus = [&](std::size_t k, std::size_t l) {
    return (at(l) - at(k)) / (natural(result.strain[l]) - natural(result.strain[k]));
  };
  CHECK((result.p[20] - result.q[20] / 3) / at(20) == Approx(0.4).epsilon(0.02));  // 101 kPa, from 0.1 kPa
  CHECK(modulus(10, 20) == Approx(3e7).epsilon(0.02));
  CHECK((result.p[30] - result.q[30] / 3) / at(30) == Approx(0.4).epsilon(0.01));
  CHECK(modulus(29, 30) == Approx(3e7 * std::sqrt(std::sqrt(at(29) * at(30)) / 1e5)).epsilon(0.02));
  CHECK(modulus(30, 40) > 3 * modulus(29, 30));  // unloading is elastic, and begins with G0
}

TEST_CASE("Hardening Soil small loses stiffness by 1/(1 + 0.385 gamma/gamma_07)") {
  const HardeningSoilSmall law(hardening_sand);
  for (const double gamma : {1e-6, 1e-5, 1e-4, 1.5e-4}) {
    const double ratio = law.shear_stress(gamma, 1e5) / gamma / 1.2e8;
    CHECK(ratio == Approx(1 / (1 + 0.385 * gamma / 1.5e-4)).epsilon(1e-12));
  }
  CHECK(law.shear_stress(1.5e-4, 1e5) / 1.5e-4 / 1.2e8 == Approx(0.722).epsilon(1e-3));
  CHECK(law.shear_stress(1e-6, 4e5) / law.shear_stress(1e-6, 1e5) == Approx(2).epsilon(1e-9));  // m = 0.5
  // The element, unloaded: q falls by 2 G_s (eps_a - eps_r) with the secant of the same law, until G_ur.
  ElementTest test;
  test.name = "unloading", test.loading = Loading::undrained, test.p0 = 1e5, test.e0 = 0.6;
  for (const double eps : {0.0, 3e-4, 3e-4 - 1e-5}) add_row(test, -std::expm1(-eps), 1e5);
  HardeningSoilParameters given = hardening_sand;
  given.m = 1e-9;
  const auto result = calculate(HardeningSoilSmall(given, false), test).test;
  const double gamma = 1.5e-5, secant = 1.2e8 / (1 + 0.385 * gamma / 1.5e-4);
  CHECK(result.q[1] - result.q[2] == Approx(2 * secant * gamma).epsilon(1e-3));
}

TEST_CASE("Hardening Soil agrees with curves read from PLAXIS on Berlin Sand III within 30 to 50 %") {
  // PLAXIS 2014, Hardening Soil Model, table 15.1, figures 15.4 (drained) and 15.5 (undrained), as read off,
  // second-hand, by the tests of github.com/fkkarakurt/katai2d: sigma_3 = 200 kPa, c = 1 kPa. Without small strains.
  // The cohesion is a shift of all stresses, and of p_ref, by c cot(phi).
  const double phi = 38 * 0.017453292519943295, shift = 1e3 / std::tan(phi), p0 = 200e3 + shift;
  const double E = 105e6 * std::pow(1e5 / (1e5 + shift), 0.55);
  const HardeningSoilSmall law({38, 6, E, E, 3 * E, 0.55, 0.2, 0.38, 0.9, 0, 1e-4});
  const auto drained = calculate(law, sheared("d", Loading::drained, p0, 0.6, 0.05, 100)).test;
  double contraction = 0;
  for (const double eps_v : drained.eps_v) contraction = std::max(contraction, eps_v);
  CHECK(drained.q.back() == Approx(646e3).epsilon(3e-3));
  CHECK(contraction == Approx(1e-3).margin(5e-4));
  CHECK(drained.eps_v.back() < -2.5e-3);  // the bounds of those tests, around -0.005
  CHECK(drained.eps_v.back() > -8e-3);
  const auto undrained = calculate(law, sheared("u", Loading::undrained, p0, 0.6, 0.03, 100)).test;
  double highest = 0;
  const auto pore_pressure = [&](std::size_t k) { return p0 - (undrained.p[k] - undrained.q[k] / 3); };
  for (std::size_t k = 0; k < undrained.q.size(); ++k) highest = std::max(highest, pore_pressure(k));
  CHECK(highest == Approx(100e3).epsilon(0.3));
  CHECK(pore_pressure(undrained.q.size() - 1) == Approx(-200e3).epsilon(0.3));
}

TEST_CASE("Hardening Soil small starts a drained test with G0") {
  HardeningSoilParameters given = hardening_sand;
  given.G0 = 4e8;  // ten times G_ur: plastic strain is kept small by the factor of Benz
  const HardeningSoilSmall law(given, false);
  const auto result = calculate(law, sheared("d", Loading::drained, 1e5, 0.6, 2e-6, 5)).test;
  CHECK(result.q.back() / result.strain.back() == Approx(2 * 1.2 * 4e8).epsilon(0.03));
}

TEST_CASE("cyclic shear closes its loop by Masing's rule") {
  const HardeningSoilSmall law(hardening_sand);
  ElementTest test;
  test.name = "c", test.loading = Loading::cyclic_shear, test.p0 = 1e5, test.e0 = 0.6;
  for (const double gamma : {0.0, 1e-4, 0.0, -1e-4, 0.0, 1e-4}) add_row(test, gamma, 1e5);
  const auto result = calculate(law, test).test;
  CHECK(result.q[3] == Approx(-result.q[1]).epsilon(1e-9));
  CHECK(result.q[5] == Approx(result.q[1]).epsilon(1e-9));
  CHECK(result.q[4] == Approx(-result.q[2]).epsilon(1e-9));
  CHECK(result.q[2] < 0);
}
