#include "rvelab/ensemble/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace rvelab::ensemble {
namespace {

/// Integral of cos(x)^power from 0 to `end`, by Simpson's rule.
double integral_of_cosine(double power, double end) {
  constexpr int intervals = 2000;
  double sum = 0;
  for (int k = 0; k <= intervals; ++k) {
    const double weight = k == 0 || k == intervals ? 1 : k % 2 == 1 ? 4 : 2;
    sum += weight * std::pow(std::max(0.0, std::cos(end * k / intervals)), power);
  }
  return sum * end / intervals / 3;
}

std::string fixed(double value, int decimals) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

/// Decimals of a number whose first digit stands `digits` digits before its last.
int decimals_for(double size, int digits) {
  return std::max(0, digits - 1 - static_cast<int>(std::floor(std::log10(size))));
}

}  // namespace

Spread spread_of(const std::vector<double>& values) {
  Spread found;
  double sum = 0;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    sum += value;
    ++found.n;
  }
  const auto n = static_cast<double>(found.n);
  found.mean = found.n > 0 ? sum / n : nan;
  found.standard_deviation = found.standard_error = found.low = found.high = nan;
  if (found.n < 2) return found;
  double squares = 0;
  for (const double value : values) {
    if (!std::isnan(value)) squares += (value - found.mean) * (value - found.mean);
  }
  found.standard_deviation = std::sqrt(squares / (n - 1));
  found.standard_error = found.standard_deviation / std::sqrt(n);
  const double reach = students_t(n - 1) * found.standard_error;
  found.low = found.mean - reach;
  found.high = found.mean + reach;
  return found;
}

Difference difference_of(const Spread& one, const Spread& other) {
  const double a = one.standard_error * one.standard_error, b = other.standard_error * other.standard_error;
  Difference found{one.mean - other.mean, std::sqrt(a + b), nan, nan};
  if (!(found.standard_error > 0)) return found;
  const double freedom = (a + b) * (a + b) / (a * a / double(one.n - 1) + b * b / double(other.n - 1));
  const double reach = students_t(freedom) * found.standard_error;
  found.low = found.value - reach;
  found.high = found.value + reach;
  return found;
}

double students_t(double freedom) {
  // With t = sqrt(nu) tan x the distribution function is an integral of cos(x)^(nu - 1).
  const double whole = integral_of_cosine(freedom - 1, std::numbers::pi / 2);
  double low = 0, high = std::numbers::pi / 2;
  for (int round = 0; round < 60; ++round) {
    const double middle = 0.5 * (low + high);
    (integral_of_cosine(freedom - 1, middle) < 0.95 * whole ? low : high) = middle;
  }
  return std::sqrt(freedom) * std::tan(low);
}

std::string with_error(double value, double error) {
  if (!std::isfinite(value)) return "-";
  const bool known = std::isfinite(error) && error > 0;
  const double size = std::max(std::abs(value), known ? error : 0);
  if (size == 0) return "0";
  const bool is_long = size >= 1e5 || size < 1e-3;
  const int power = is_long ? 3 * static_cast<int>(std::floor(std::log10(size) / 3)) : 0;
  const double unit = std::pow(10.0, power);
  const std::string end = is_long ? "e" + std::to_string(power) : "";
  if (!known) return fixed(value / unit, decimals_for(size / unit, 4)) + end;
  const int decimals = std::min(12, decimals_for(error / unit, 2));
  const std::string both = fixed(value / unit, decimals) + " +- " + fixed(error / unit, decimals);
  return is_long ? "(" + both + ")" + end : both;
}

std::string in_digits_of(double value, double error) {
  const std::string text = with_error(value, error);
  if (!text.starts_with('(')) return text.substr(0, text.find(" +-"));
  return text.substr(1, text.find(" +-") - 1) + text.substr(text.find(')') + 1);
}

}  // namespace rvelab::ensemble
