#include "rvelab/fit/parameters.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>

#include "rvelab/ensemble/features.hpp"
#include "rvelab/ensemble/measures.hpp"
#include "rvelab/error.hpp"
#include "rvelab/keys/key.hpp"

namespace rvelab::fit {
namespace {

std::optional<double> number_of(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
  return whole ? std::optional(value) : std::nullopt;
}

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, at);) parts.push_back(part);
  return parts;
}

[[noreturn]] void refuse_vary(const std::string& text, const std::string& what) {
  throw InputError("--vary " + text + " " + what +
                   "; allowed: KEY=low:high, KEY=low:high:n for a sweep, with :log behind it for steps in the "
                   "logarithm; write for example material.friction=0.1:1.0");
}

[[noreturn]] void refuse_target(const std::string& text, const std::string& what) {
  throw InputError("--target " + text + " " + what +
                   "; allowed: MEASURE=value, =value+-error, MEASURE@pressure=value; write for example "
                   "friction_angle_deg=30+-0.5");
}

}  // namespace

double Parameter::value(double point) const {
  const double found = logarithmic ? low * std::pow(high / low, point) : low + point * (high - low);
  const double whole = std::round(found);  // a number of grains, not 200.00000000000003
  return std::abs(found - whole) < 1e-12 * std::abs(whole) ? whole : found;
}

std::string Parameter::assignment(double value) const {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  return key + "=" + std::string(digits, end);
}

Parameter parsed_parameter(const std::string& text) {
  Parameter found;
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0) refuse_vary(text, "is no key with a range");
  found.key = text.substr(0, equals);
  std::vector<std::string> parts = split(text.substr(equals + 1), ':');
  if (!parts.empty() && parts.back() == "log") {
    found.logarithmic = true;
    parts.pop_back();
  }
  if (parts.size() < 2 || parts.size() > 3) refuse_vary(text, "has no two ends of a range");
  const auto low = number_of(parts[0]), high = number_of(parts[1]);
  if (!low || !high) refuse_vary(text, "has an end that is no number");
  if (!(*low < *high)) refuse_vary(text, "has no lower end below its upper end");
  if (found.logarithmic && !(*low > 0)) refuse_vary(text, "has no logarithm at its lower end");
  found.low = *low;
  found.high = *high;
  if (parts.size() == 2) return found;
  const auto grid = number_of(parts[2]);
  if (!grid || *grid != std::floor(*grid) || *grid < 2 || *grid > 1000)
    refuse_vary(text, "asks for " + parts[2] + " values of a sweep, and not for 2 to 1000");
  found.grid = static_cast<long>(*grid);
  return found;
}

ScalarTarget parsed_target(const std::string& text) {
  ScalarTarget found;
  const auto equals = text.find('=');
  if (equals == std::string::npos) refuse_target(text, "has no value");
  const std::vector<std::string> name = split(text.substr(0, equals), '@');
  if (name.empty() || name.size() > 2) refuse_target(text, "names no measure");
  found.measure = name[0];
  std::vector<std::string> known;
  for (const auto& measure : ensemble::measures()) known.push_back(measure.name);
  const bool is_measure = std::find(known.begin(), known.end(), found.measure) != known.end();
  if (!is_measure && !ensemble::feature_of(found.measure)) {
    for (const std::string& feature : ensemble::feature_names())
      if (std::find(known.begin(), known.end(), feature) == known.end()) known.push_back(feature);
    std::string all;
    for (const std::string& each : known) all += (all.empty() ? "" : ", ") + each;
    throw InputError("--target " + text + ": no test gives " + found.measure +
                     keys::nearest_in_words(found.measure, known) + "; allowed: " + all + "; name one of these");
  }
  if (name.size() == 2) {
    const auto pressure = number_of(name[1]);
    if (!pressure || !(*pressure > 0)) refuse_target(text, "has no pressure in Pa behind @");
    found.pressure = *pressure;
  }
  const std::string values = text.substr(equals + 1);
  const auto sign = values.find("+-");
  const auto value = number_of(values.substr(0, sign));
  const auto error = sign == std::string::npos ? std::optional(0.0) : number_of(values.substr(sign + 2));
  if (!value || !error || *error < 0) refuse_target(text, "has a value or an error that is no number");
  found.value = *value;
  found.error = *error;
  return found;
}

}  // namespace rvelab::fit
