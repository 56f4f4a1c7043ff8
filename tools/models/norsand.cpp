#include "tools/models/norsand.hpp"

#include <algorithm>
#include <cmath>

#include "tools/models/description.hpp"
#include "tools/models/plasticity.hpp"

namespace rvelab::models {
namespace {

constexpr double kPa = 1e3;

struct StraightLine {
  double Gamma, lambda;
};
struct Line {
  StraightLine value;
  Origin origin;
};

/// Through void ratios at two pressures.
StraightLine chord(double low, double e_low, double high, double e_high) {
  const double lambda = (e_low - e_high) / std::log(high / low);
  return {e_low + lambda * std::log(low / kPa), lambda};
}

/// Critical state line of the sheet over ln p; of a curved one, e = e_G - lambda (p/p_a)^xi, the chord between the
/// lowest and highest mean stress of the tests. Without one it is fitted, from the ends of the tests.
Line line_of(const Tests& tests, const Numbers& numbers) {
  const auto all = [&](const auto&... keys) { return (has_number(numbers, keys) && ...); };
  if (all("critical_line_Gamma", "critical_line_lambda_ln"))
    return {{numbers.at("critical_line_Gamma"), numbers.at("critical_line_lambda_ln")}, Origin::sheet};
  if (all("critical_line_e_G", "critical_line_lambda", "critical_line_xi")) {
    double low = 1e300, high = 0;
    for (const ElementTest& test : shear_tests(tests)) {
      low = std::min(low, test.p0);
      for (const double p : test.p) high = std::max(high, p);
    }
    const auto e_c = [&](double p) {
      return numbers.at("critical_line_e_G") -
             numbers.at("critical_line_lambda") * std::pow(p / 101325, numbers.at("critical_line_xi"));
    };
    return {chord(low, e_c(low), high, e_c(high)), Origin::sheet};
  }
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const ElementTest& test : shear_tests(tests)) {
    const double u = std::log(test.p.back() / kPa), v = void_ratio_at_the_end(test);
    n += 1, x += u, y += v, xx += u * u, xy += u * v;
  }
  const double spread = xx - x * x / n;
  const double lambda = spread > 0.1 ? std::clamp(-(xy - x * y / n) / spread, 0.005, 0.1) : 0.02;
  return {{y / n + lambda * x / n, lambda}, Origin::fitted};
}

std::string missing_of_norsand(const Tests& tests) {
  const Tests shear = shear_tests(tests);
  if (shear.size() < 3) return "three drained or undrained tests at least";
  double low = 1e9, high = 0, end_low = 1e300, end_high = 0;
  for (const ElementTest& test : shear) {
    low = std::min(low, test.e0), high = std::max(high, test.e0);
    end_low = std::min(end_low, test.p.back()), end_high = std::max(end_high, test.p.back());
  }
  if (end_high < 1.2 * end_low && high - low < 0.02) return "tests at two pressures or two void ratios at least";
  return "";
}

std::vector<Entry> parameters_of_norsand(const Tests& tests, const Numbers& numbers) {
  constexpr Origin fitted = Origin::fitted;
  const Line line = line_of(tests, numbers);
  const double s = std::sin(number_or(numbers, "phi_cs_deg", 31) * degree);
  const double M = has_number(numbers, "phi_cs_deg") ? 6 * s / (3 - s) : stress_ratio_at_the_end(tests);
  return {
      {"Gamma", "", "critical void ratio at 1 kPa", line.value.Gamma, 0.1, 3, line.origin, false},
      {"lambda", "",
       line.origin == Origin::sheet
           ? "slope of the critical state line over ln p"
           : "slope of the critical state line over ln p, of which the sheet has no measured one",
       line.value.lambda, 1e-4, 0.3, line.origin, true},
      {"M_tc", "", "critical q/p in triaxial compression", M, 0.5, 2.2, sheet_or(numbers, "phi_cs_deg", fitted), false},
      {"N", "", "volumetric coupling", 0.3, 0, 0.9, fitted, false},
      {"chi", "", "largest dilation over the state parameter", 3.5, 0.5, 15, fitted, true},
      {"H", "", "plastic hardening", 150, 2, 20000, fitted, true},
      {"I_r", "", "shear stiffness over the mean stress, at 100 kPa", 500, 20, 20000, fitted, true},
      {"nu", "", "Poisson's ratio", number_or(numbers, "nu_ur", 0.2), 0, 0.5,
       sheet_or(numbers, "nu_ur", Origin::assumed), false},
      {"n", "", "exponent of the shear stiffness over stress", number_or(numbers, "G0_exponent", 1), 0, 1,
       sheet_or(numbers, "G0_exponent", Origin::assumed), false},
  };
}

std::unique_ptr<Law> law_of_norsand(const std::vector<double>& v) {
  return std::make_unique<NorSand>(NorSandParameters{v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8]});
}

}  // namespace

NorSand::NorSand(const NorSandParameters& parameters) : given(parameters) {
  chi_i = given.chi / std::max(0.1, 1 - given.lambda * given.chi / given.M_tc);
}

double NorSand::state_parameter(const Element& at) const {
  return at.e - given.Gamma + given.lambda * std::log(at.p() / kPa);
}

NorSand::Image NorSand::image(const Element& at, bool compression) const {
  Image image{};
  image.psi = at.e - given.Gamma + given.lambda * std::log(std::max(at.memory[0], 1.0) / kPa);
  image.M = compression ? given.M_tc : 3 * given.M_tc / (3 + given.M_tc);
  image.M_itc = std::max(0.1 * given.M_tc, given.M_tc - given.N * chi_i * std::abs(image.psi));
  image.M_i = image.M * image.M_itc / given.M_tc;
  return image;
}

void NorSand::start(Element& at) const {
  at.memory = {};
  at.memory[0] = at.p() * std::exp(-1.0);
}

Rate NorSand::rate(const Element& at, StrainRate d) const {
  const double p = at.p(), p_i = std::max(at.memory[0], 1.0);
  const bool isotropic = std::abs(at.q()) <= 1e-9 * p && std::abs(d.a - d.r) <= 1e-9 * std::abs(d.a);
  const bool compression = at.q() > 1e-9 * p || (at.q() > -1e-9 * p && d.a >= d.r);
  const double side = isotropic ? 0 : compression ? 1 : -1, eta = std::abs(at.q()) / p;
  const Image image = this->image(at, compression);
  const double shear = given.I_r * p_ref * std::pow(p / p_ref, given.elastic_exponent);
  const Elasticity elastic{2 * shear * (1 + given.nu) / (3 * (1 - 2 * given.nu)), shear};

  const double D = image.M_i - eta, D_min = chi_i * image.psi;
  double growth = given.H * image.M_i / image.M_itc * (p / p_i) * (p / p_i) *
                  (std::exp(-D_min / image.M_itc) - p_i / p);  // of ln p_i, per eps_q
  if (std::abs(d.volumetric()) <= 1e-9 * std::abs(d.a)) {
    const double eta_L = image.M_i * (1 - D_min / image.M_itc);
    growth -= eta / eta_L * D * elastic.bulk / p / (1 + chi_i * given.lambda / given.M_tc);
  }
  // f = |q| - p M_i (1 + ln(p_i/p)); M_i changes with the void ratio and with p_i.
  const double by_M_i = -p * (1 + std::log(p_i / p));
  const double by_psi = -image.M / given.M_tc * given.N * chi_i * (image.psi > 0 ? 1 : -1) * by_M_i;
  Mechanism yield;
  yield.active = eta >= image.M_i * (1 + std::log(p_i / p)) - 1e-3;
  yield.normal = {side + D / 3, -side + 2 * D / 3};
  yield.flow = {side + D / 3, -0.5 * side + D / 3};
  yield.drift = -by_psi * (1 + at.e) * d.volumetric();
  yield.hardening = (p * image.M_i - by_psi * given.lambda) * growth;
  const auto plastic = plastic_rate(elastic, {yield, {}}, d);
  return {plastic.stress[0], plastic.stress[1], {p_i * growth * plastic.multiplier[0]}};
}

void NorSand::settle(Element& at) const {
  const double eta = std::abs(at.q()) / at.p();
  for (int k = 0; k < 2; ++k) {
    const double M_i = image(at, at.q() >= 0).M_i;
    if (eta < M_i * (1 + std::log(at.memory[0] / at.p())) - 1e-3) return;
    at.memory[0] = at.p() * std::exp(eta / M_i - 1);
  }
}

const Description& norsand() {
  static const Description description{"norsand", "NorSand", missing_of_norsand, parameters_of_norsand, law_of_norsand,
                                       nullptr,   nullptr};
  return description;
}

}  // namespace rvelab::models
