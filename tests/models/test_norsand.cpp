#include <cmath>

#include "tests/catch.hpp"
#include "tests/models/element_tests.hpp"
#include "tools/models/norsand.hpp"

using namespace rvelab::models;
using namespace rvelab::test;

namespace {

const NorSandParameters nor_sand{0.9, 0.03, 1.25, 0.35, 4, 150, 400, 0.2};

/// A test by NorTxl2, the program of Jefferies and Been, in strains of a laboratory.
ElementTest nortxl(const std::string& what, Loading loading) {
  ElementTest test;
  test.name = what, test.loading = loading, test.p0 = 5e5, test.e0 = 0.853304;
  for (const auto& row : kept("nortxl_" + what + ".csv")) {
    test.strain.push_back(std::stod(row.at("eps_a")) / 100);
    test.eps_v.push_back(std::stod(row.at("eps_v")) / 100);
    test.p.push_back(std::stod(row.at("p")) * 1e3);
    test.q.push_back(std::stod(row.at("q")) * 1e3);
  }
  return test;
}

NorSand nerlerk(double H) {
  NorSandParameters given{0.875, 0.02087, 1.45, 0.43, 3.4, H, 0, 0.15, 0.4};
  given.I_r = 71.5e6 / (1e5 * std::pow(5, 0.4));
  return NorSand(given);
}

}  // namespace

TEST_CASE("NorSand is that of the program NorTxl2 in a drained test on loose sand") {
  const ElementTest test = nortxl("drained", Loading::drained);
  REQUIRE(test.q.size() > 70);
  const auto result = calculate(nerlerk(50), test).test;
  for (std::size_t k = 0; k < test.q.size(); ++k) {
    CHECK(result.q[k] == Approx(test.q[k]).margin(1e-3 * 1236e3));
    CHECK(result.eps_v[k] == Approx(test.eps_v[k]).margin(1e-5));
  }
}

TEST_CASE("NorSand is that of the program NorTxl2 in undrained collapse") {
  // The program's pore water is compressible, by 5e-4 of the volume at the end.
  const ElementTest test = nortxl("undrained", Loading::undrained);
  const auto calculated = calculate(nerlerk(40), test);
  CHECK(calculated.remark.empty());
  for (std::size_t k = 0; k < test.q.size(); ++k) {
    CHECK(calculated.test.q[k] == Approx(test.q[k]).margin(0.01 * 5e5));
    CHECK(calculated.test.p[k] == Approx(test.p[k]).margin(0.025 * 5e5));
  }
}

TEST_CASE("NorSand ends on the critical state line from loose and dense") {
  for (const double e0 : {0.68, 0.80}) {
    const auto result = calculate(NorSand(nor_sand), sheared("d", Loading::drained, 2e5, e0, 0.9, 60)).test;
    const double p = result.p.back(), e = e0 - (1 + e0) * result.eps_v.back();
    CHECK(result.q.back() == Approx(1.25 * p).epsilon(5e-3));
    CHECK(e == Approx(0.9 - 0.03 * std::log(p / 1e3)).margin(3e-3));
  }
  const auto undrained = calculate(NorSand(nor_sand), sheared("u", Loading::undrained, 2e5, 0.72, 0.6, 60)).test;
  CHECK(undrained.q.back() == Approx(1.25 * undrained.p.back()).epsilon(5e-3));
  CHECK(undrained.p.back() == Approx(1e3 * std::exp((0.9 - 0.72) / 0.03)).epsilon(0.03));
}

TEST_CASE("NorSand's largest dilation is chi times the state parameter, and its peak is M_tc - (1 - N) chi_i psi_i") {
  // At the largest dilation D_min = chi_i psi_i = chi psi, chi_i = chi/(1 - lambda chi/M_tc); there eta = M_i - D.
  const double e0 = 0.66, chi_i = 4 / (1 - 0.03 * 4 / 1.25);
  NorSandParameters stiff = nor_sand;
  stiff.I_r = 1e5;  // plastic strain alone
  const auto result = calculate(NorSand(stiff), sheared("d", Loading::drained, 1e5, e0, 0.2, 400)).test;
  double dilation = 0, eta = 0, state = 0;
  for (std::size_t k = 1; k < result.q.size(); ++k) {
    const double eps_v = std::log1p(-result.eps_v[k - 1]) - std::log1p(-result.eps_v[k]);
    const double eps_a = std::log1p(-result.strain[k - 1]) - std::log1p(-result.strain[k]);
    const double D = eps_v / (eps_a - eps_v / 3);
    if (D >= dilation) continue;
    dilation = D, eta = result.q[k] / result.p[k];
    const double e = e0 - (1 + e0) * result.eps_v[k];
    state = e - 0.9 + 0.03 * std::log(result.p[k] / 1e3);
  }
  const double psi_i = dilation / chi_i;
  CHECK(dilation == Approx(4 * state).epsilon(0.03));
  CHECK(eta == Approx(1.25 - 0.35 * chi_i * std::abs(psi_i) - dilation).epsilon(0.01));
}

TEST_CASE("NorSand is elastic in unloading, with G = I_r p") {
  ElementTest test = compressed("o", Loading::oedometer, 1e5, 0.7, {4e5, 3.9e5}, 1);
  const auto result = calculate(NorSand(nor_sand), test).test;
  const double p = 0.5 * (result.p[1] + result.p[2]), G = 400 * p, nu = 0.2;
  const double oedometer = 2 * G * (1 - nu) / (1 - 2 * nu);
  const double strain = std::log1p(-result.strain[2]) - std::log1p(-result.strain[1]);
  CHECK(1e4 / strain == Approx(oedometer).epsilon(2e-3));
}
