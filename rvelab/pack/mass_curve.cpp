#include "rvelab/pack/mass_curve.hpp"

#include <algorithm>
#include <cmath>

#include "rvelab/cell/cube_root.hpp"

namespace rvelab::pack {

double power_of(double radius, int dimension) { return dimension == 2 ? radius * radius : radius * radius * radius; }

double root_of(double power, int dimension) {
  if (!(power > 0 && std::isfinite(power))) return 0;
  return dimension == 2 ? std::sqrt(power) : cube_root(power);
}

double in_three_digits_down(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - 2);
  return unit * std::floor(value / unit * (1 + 1e-12));
}

MassCurve::MassCurve(NumberCurve by_number, int dimension) : by_number_(std::move(by_number)), dimension_(dimension) {
  power_.push_back(0);
  for (std::size_t k = 1; k < by_number_.radii.size(); ++k)
    power_.push_back(power_.back() + power_from(k - 1, by_number_.passing[k]));
}

std::size_t MassCurve::knot_below(const std::vector<double>& values, double value) const {
  const auto above = std::upper_bound(values.begin(), values.end(), value);
  return std::clamp(std::size_t(above - values.begin()), std::size_t{1}, values.size() - 1) - 1;
}

double MassCurve::power_from(std::size_t k, double number) const {
  const double width = by_number_.passing[k + 1] - by_number_.passing[k], part = number - by_number_.passing[k];
  if (!(width > 0)) return 0;
  const double a = by_number_.radii[k], b = a + (by_number_.radii[k + 1] - a) * (part / width);
  // Simpson's rule: exact for powers up to three, since r is straight over the number.
  return part * (power_of(a, dimension_) + 4 * power_of(0.5 * (a + b), dimension_) + power_of(b, dimension_)) / 6;
}

double MassCurve::mass_at(double number) const {
  const std::size_t k = knot_below(by_number_.passing, number);
  return std::clamp((power_[k] + power_from(k, number)) / power_.back(), 0.0, 1.0);
}

double MassCurve::number_at(double mass) const {
  const double power = mass * power_.back();
  const std::size_t k = knot_below(power_, power);
  double low = by_number_.passing[k], high = by_number_.passing[k + 1];
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (low + high);
    (power_[k] + power_from(k, middle) < power ? low : high) = middle;
  }
  return high;
}

std::vector<double> radii_passing(std::vector<std::pair<double, double>> grains, const std::vector<double>& parts) {
  std::sort(grains.begin(), grains.end());
  double all = 0, passed = 0;
  for (const auto& [radius, mass] : grains) all += mass;
  std::vector<double> radii;
  std::size_t k = 0;
  for (const double part : parts) {
    while (k + 1 < grains.size() && passed + grains[k].second < part * all) passed += grains[k++].second;
    radii.push_back(grains[k].first);
  }
  return radii;
}

}  // namespace rvelab::pack
