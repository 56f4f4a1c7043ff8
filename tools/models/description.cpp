#include "tools/models/description.hpp"

#include <algorithm>
#include <cmath>

#include "tools/models/plasticity.hpp"

namespace rvelab::models {

bool has_number(const Numbers& numbers, const std::string& key) {
  const auto found = numbers.find(key);
  return found != numbers.end() && std::isfinite(found->second);
}

Origin sheet_or(const Numbers& numbers, const std::string& key, Origin otherwise) {
  return has_number(numbers, key) ? Origin::sheet : otherwise;
}

double number_or(const Numbers& numbers, const std::string& key, double otherwise) {
  return has_number(numbers, key) ? numbers.at(key) : otherwise;
}

Tests of_loading(const Tests& tests, Loading loading) {
  Tests found;
  for (const ElementTest& test : tests)
    if (test.loading == loading) found.push_back(test);
  return found;
}

Tests shear_tests(const Tests& tests) {
  Tests found;
  for (const ElementTest& test : tests)
    if (test.loading == Loading::drained || test.loading == Loading::undrained) found.push_back(test);
  return found;
}

bool several_pressures(const Tests& tests) {
  const auto [low, high] =
      std::minmax_element(tests.begin(), tests.end(), [](const auto& a, const auto& b) { return a.p0 < b.p0; });
  return !tests.empty() && high->p0 > 1.2 * low->p0;
}

double largest_friction_angle_deg(const Tests& tests) {
  double sum = 0;
  const Tests shear = shear_tests(tests);
  for (const ElementTest& test : shear) {
    double sine = 0;
    for (std::size_t k = 0; k < test.q.size(); ++k)
      sine = std::max(sine, std::abs(test.q[k]) / (2 * test.p[k] + test.q[k] / 3));
    sum += std::asin(std::min(sine, 0.9)) / degree;
  }
  return std::clamp(sum / double(shear.size()), 10.0, 60.0);
}

double stress_ratio_at_the_end(const Tests& tests) {
  double sum = 0;
  const Tests shear = shear_tests(tests);
  for (const ElementTest& test : shear) sum += test.q.back() / test.p.back();
  return std::clamp(sum / double(shear.size()), 0.6, 2.0);
}

double void_ratio_at_the_end(const ElementTest& test) { return test.e0 - (1 + test.e0) * test.eps_v.back(); }

SecantModulus secant_modulus(const Tests& tests) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const ElementTest& test : shear_tests(tests)) {
    const double half = 0.5 * *std::max_element(test.q.begin(), test.q.end());
    for (std::size_t k = 0; k < test.q.size(); ++k) {
      if (test.q[k] < half || !(test.strain[k] > 0)) continue;
      const double u = std::log(test.p0 / p_ref), v = std::log(test.q[k] / test.strain[k]);
      n += 1, x += u, y += v, xx += u * u, xy += u * v;
      break;
    }
  }
  if (n == 0) return {5e7, 0.5};
  const double spread = xx - x * x / n;
  const double exponent = spread > 0.05 ? (xy - x * y / n) / spread : 0.5;
  return {std::exp(y / n - exponent * x / n), exponent};
}

double oedometer_modulus(const Tests& tests, double exponent) {
  for (const ElementTest& test : of_loading(tests, Loading::oedometer)) {
    double largest = 0;
    for (std::size_t k = 1; k < test.q.size(); ++k) {
      const double low = axial_stress(test, k - 1), high = axial_stress(test, k);
      const bool first = low >= 0.999 * largest && high > low && test.strain[k] > test.strain[k - 1];
      largest = std::max({largest, low, high});
      const double middle = std::sqrt(std::max(low, 1.0) * high);
      if (!first || high < 1.5 * test.p0 || middle < p_ref) continue;
      return (high - low) / (test.strain[k] - test.strain[k - 1]) * std::pow(middle / p_ref, -exponent);
    }
  }
  return secant_modulus(tests).at_100_kPa;
}

}  // namespace rvelab::models
