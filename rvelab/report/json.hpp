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

/// A table: a list of rows, a row a list of texts, the first row the head (empty texts: none).
using Table = std::vector<std::vector<std::string>>;

}  // namespace rvelab::report
