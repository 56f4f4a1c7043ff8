#include "rvelab/report/words.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "rvelab/ensemble/statistics.hpp"

namespace rvelab::report {
namespace {

/// With a minus sign instead of the hyphen before a number.
std::string with_minus(const std::string& text) { return text.starts_with('-') ? "\u2212" + text.substr(1) : text; }

}  // namespace

std::string in_three_digits(double value) {
  if (!std::isfinite(value)) return "-";
  if (value == 0) return "0";
  // 99,950 becomes 100,000 by rounding: the power is that of the rounded number.
  char text[32];
  std::snprintf(text, sizeof text, "%.2e", value);
  const int decade = std::stoi(std::string(text).substr(std::string(text).find('e') + 1));
  const int power = decade >= 5 || decade < -3 ? 3 * int(std::floor(decade / 3.0)) : 0;
  std::snprintf(text, sizeof text, "%.*f", std::max(0, 2 - (decade - power)), value / std::pow(10.0, power));
  std::string whole = text;
  if (decade - power > 2) {  // zeros instead of digits that are not significant
    std::snprintf(text, sizeof text, "%.0f",
                  std::round(value / std::pow(10.0, decade - 2)) * std::pow(10.0, decade - 2));
    whole = text;
  }
  return with_minus(whole) + (power != 0 ? "e" + std::to_string(power) : "");
}

InUnit fitting_unit(double value, const std::string& unit) {
  const double size = std::abs(value);
  if (unit == "Pa" && size >= 1e9) return {1e-9, "GPa"};
  if (unit == "Pa" && size >= 1e6) return {1e-6, "MPa"};
  if (unit == "Pa") return {1e-3, "kPa"};
  return {1, unit};
}

std::string with_its_error(double value, double error) {
  if (!std::isfinite(error) || error <= 0) return in_three_digits(value);
  std::string text = ensemble::with_error(value, error);
  if (const auto at = text.find("+-"); at != std::string::npos) text.replace(at, 2, "\u00b1");
  return with_minus(text);
}

std::string interval_in_words(double low, double high) {
  if (!std::isfinite(low) || !std::isfinite(high)) return "";
  const double half = 0.5 * (high - low);
  return with_minus(ensemble::in_digits_of(low, half)) + " to " + with_minus(ensemble::in_digits_of(high, half));
}

std::string counted(std::size_t number, const std::string& what) {
  return std::to_string(number) + " " + what + (number == 1 ? "" : "s");
}

}  // namespace rvelab::report
