// Data of a page as JSON: numbers with six digits, more than a picture resolves; undefined values are null.
#pragma once

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace rvelab::report {

using Json = nlohmann::ordered_json;

inline Json number(double value) {
  if (!std::isfinite(value)) return {};
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return std::stod(text);
}

inline Json numbers(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(number(value));
  return list;
}

/// What colours the grains or points of a page, whose finite values over all states are `sorted`: its range, and the
/// part of it that the scale shows.
template <class Field>
Json described_field(const Field& field, const std::vector<double>& sorted) {
  const auto part = [&](double p) { return number(sorted[std::size_t(p * double(sorted.size() - 1))]); };
  return {{"key", field.key}, {"label", field.label}, {"unit", field.unit}, {"about_zero", field.about_zero},
          {"low", part(0)},   {"high", part(1)},      {"from", part(0.01)}, {"to", part(0.99)}};
}

/// A table: a list of rows, a row a list of texts, the first row the head (empty texts: none).
using Table = std::vector<std::vector<std::string>>;

}  // namespace rvelab::report
