#include "tools/models/hypoplasticity.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/models/description.hpp"
#include "tools/models/plasticity.hpp"

namespace rvelab::models {
namespace {

constexpr double largest_over_critical = 1.15;  ///< e_i0/e_c0, Herle and Gudehus 1999

std::string missing_of_hypoplasticity(const Tests& tests) {
  if (shear_tests(tests).size() < 3) return "three drained or undrained tests at least";
  if (of_loading(tests, Loading::oedometer).empty() && of_loading(tests, Loading::isotropic).empty())
    return "an oedometer or isotropic compression test";
  return "";
}

std::vector<Entry> parameters_of_hypoplasticity(const Tests& tests, const Numbers& numbers) {
  constexpr Origin fitted = Origin::fitted;
  const double M = stress_ratio_at_the_end(tests);
  double e_c0 = 0, densest = 1e9;
  for (const ElementTest& test : shear_tests(tests)) {
    e_c0 = std::max(e_c0, 1.05 * void_ratio_at_the_end(test));
    densest = std::min(densest, test.e0);
  }
  e_c0 = number_or(numbers, "critical_line_e_G", e_c0);
  return {
      {"phi_c", "deg", "critical friction angle", number_or(numbers, "phi_cs_deg", std::asin(3 * M / (6 + M)) / degree),
       10, 50, sheet_or(numbers, "phi_cs_deg", fitted), false},
      {"h_s", "Pa", "granulate hardness", 2e9, 1e6, 1e13, fitted, true},
      {"n", "", "exponent of compression", 0.35, 0.05, 0.9, fitted, false},
      {"e_d0", "", "smallest void ratio at p = 0", number_or(numbers, "e_d0", std::min(0.6 * e_c0, 0.9 * densest)),
       0.05, densest, sheet_or(numbers, "e_d0", fitted), false},
      {"e_c0", "", "critical void ratio at p = 0", e_c0, 0.1, 3, sheet_or(numbers, "critical_line_e_G", fitted), false},
      {"e_i0", "",
       has_number(numbers, "e_i0") ? "largest void ratio at p = 0" : "largest void ratio at p = 0: 1.15 e_c0",
       number_or(numbers, "e_i0", unknown), 0.1, 4, sheet_or(numbers, "e_i0", Origin::assumed), false},
      {"alpha", "", "exponent of density in the strength", 0.15, 0.005, 0.8, fitted, true},
      {"beta", "", "exponent of density in the stiffness", 1.3, 0.1, 8, fitted, true},
  };
}

void tie_of_hypoplasticity(std::vector<double>& v) {
  if (!std::isfinite(v[5])) v[5] = largest_over_critical * v[4];
  v[3] = std::min(v[3], 0.98 * v[4]);  // the law needs e_d0 < e_c0 < e_i0
  v[5] = std::max(v[5], 1.001 * v[4]);
}

std::unique_ptr<Law> law_of_hypoplasticity(const std::vector<double>& v) {
  return std::make_unique<Hypoplasticity>(HypoplasticityParameters{v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7]});
}

}  // namespace

Hypoplasticity::Hypoplasticity(const HypoplasticityParameters& parameters) : given(parameters) {
  const double s = std::sin(given.phi_c_deg * degree);
  a = std::numbers::sqrt3 * (3 - s) / (2 * std::numbers::sqrt2 * s);
  const double loosest = (given.e_i0 - given.e_d0) / (given.e_c0 - given.e_d0);
  barotropy = given.h_s / given.n * std::pow(given.e_i0 / given.e_c0, given.beta) /
              std::max(1e-3, 3 + a * a - a * std::numbers::sqrt3 * std::pow(loosest, given.alpha));
}

double Hypoplasticity::compression(double p) const { return std::exp(-std::pow(3 * p / given.h_s, given.n)); }

Rate Hypoplasticity::rate(const Element& at, StrainRate d) const {
  const double p = at.p(), trace = 3 * p;
  const double squeeze = compression(p);
  const double e_d = given.e_d0 * squeeze, e_c = given.e_c0 * squeeze, e_i = given.e_i0 * squeeze;
  const double f_d = at.e > e_d ? std::pow((at.e - e_d) / (e_c - e_d), given.alpha) : 0;
  const double f_e = std::pow(e_c / at.e, given.beta);
  const double f_b = barotropy * (1 + e_i) / e_i * std::pow(trace / given.h_s, 1 - given.n);

  const double T_a = at.sigma_a / trace, T_r = at.sigma_r / trace, S_a = T_a - 1.0 / 3, S_r = T_r - 1.0 / 3;
  const double square = T_a * T_a + 2 * T_r * T_r, deviator = S_a * S_a + 2 * S_r * S_r;
  double F = 1;  // triaxial compression, and isotropic stress
  if (S_a < -1e-12) {
    const double tangent = std::sqrt(3 * deviator);  // cos 3 theta = 1
    F = std::sqrt(tangent * tangent / 8 + (2 - tangent * tangent) / (2 + std::numbers::sqrt2 * tangent)) -
        tangent / (2 * std::numbers::sqrt2);
  }
  const double f_s = f_b * f_e / square, length = std::sqrt(d.a * d.a + 2 * d.r * d.r);
  const double linear = a * a * (T_a * d.a + 2 * T_r * d.r), turning = f_d * a * F * length;
  return {f_s * (F * F * d.a + T_a * linear - (T_a + S_a) * turning),
          f_s * (F * F * d.r + T_r * linear - (T_r + S_r) * turning),
          {}};
}

const Description& hypoplasticity() {
  static const Description description{"hypoplasticity",
                                       "hypoplasticity (von Wolffersdorff)",
                                       missing_of_hypoplasticity,
                                       parameters_of_hypoplasticity,
                                       law_of_hypoplasticity,
                                       tie_of_hypoplasticity,
                                       nullptr};
  return description;
}

}  // namespace rvelab::models
