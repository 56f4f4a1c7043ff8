#include "rvelab/cli/report.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

#include "rvelab/cli/columns.hpp"
#include "rvelab/io/utf8.hpp"
#include "rvelab/measure/measures.hpp"

namespace rvelab::cli {
namespace {

/// Specimens scatter by per cents: more digits say nothing in a listing.
std::string number_in_digits(double value) { return in_digits(value, 4); }

/// One value on one line: text without quotation marks, its numbers by `shown`.
std::string on_one_line(const Json& value, std::string (*shown)(double) = number_in_digits) {
  if (value.is_string()) return io::printable(value.get<std::string>());
  if (value.is_number_float()) return shown(value.get<double>());
  if (!value.is_structured()) return value.is_null() ? "-" : value.dump();
  std::string text;
  for (const auto& [key, item] : value.items()) {
    if (!text.empty()) text += value.is_object() ? ", " : "  ";
    const bool angle = value.is_object() && key.ends_with("_deg");
    text += (value.is_object() ? key + " " : "") + on_one_line(item, angle ? angle_in_digits : shown);
  }
  return text;
}

bool has_rows(const Json& value) {
  return value.is_array() && !value.empty() &&
         std::all_of(value.begin(), value.end(), [](const Json& item) { return item.is_structured(); });
}

}  // namespace

void Listing::add(const std::string& key, Json value, const std::string& unit) {
  if (value.is_number_float() && value.get<double>() == 0) value = 0.0;  // not -0
  lines_.push_back({key, std::move(value), unit});
}

void Listing::add_or_why(const std::string& key, double value, const std::string& unit, const std::string& why) {
  add(key, value, unit);
  if (std::isnan(value)) undefined_[key] = why;
}

std::string json_text(const Json& json) { return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n"; }

std::vector<double> numbers_in(const Json& row) {
  std::vector<double> numbers;
  for (const Json& value : row)
    numbers.push_back(value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>());
  return numbers;
}

std::string Listing::json() const {
  Json object = Json::object();
  for (const auto& line : lines_)
    if (line.form != Form::text) object[line.key] = line.value;
  if (!undefined_.empty()) object["undefined"] = undefined_;
  return json_text(object);
}

std::string Listing::text() const {
  std::size_t width = 0;
  for (const auto& line : lines_)
    if (line.form != Form::json) width = std::max(width, line.key.size());
  std::string text;
  const auto put = [&](const std::string& key, const std::string& value, const std::string& unit) {
    text += key + std::string(width + 2 - key.size(), ' ') + value + (unit.empty() ? "" : " " + unit) + "\n";
  };
  for (const auto& line : lines_) {
    if (line.form == Form::json) continue;
    if (undefined_.contains(line.key)) {
      put(line.key, "-  (" + on_one_line(undefined_[line.key]) + ")", "");
      continue;
    }
    if (!has_rows(line.value)) {
      const std::string shown = on_one_line(line.value, line.unit == "degrees" ? angle_in_digits : number_in_digits);
      put(line.key, shown, shown == "-" ? "" : line.unit);
      continue;
    }
    for (std::size_t row = 0; row < line.value.size(); ++row) {
      put(row == 0 ? line.key : "", on_one_line(line.value[row]), line.unit);
    }
  }
  return text;
}

void Listing::print(bool as_json) const { std::cout << (as_json ? json() : text()) << std::flush; }

void tell(const std::string& text) { std::cerr << "rvelab: " << io::message_line(text) << std::endl; }

Json row_major(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(matrix(i, j));
    rows.push_back(std::move(row));
  }
  return rows;
}

Sizes sizes_of(const Network& network) {
  return {proportions_of(network), mean_diameter(network), mean_pressure(contact_stress(network), network.dimension())};
}

Json as_json(const Sizes& sizes) {
  const Proportions& p = sizes.proportions;
  Json json;
  json["mean_diameter_m"] = sizes.mean_diameter;
  json["void_ratio"] = p.void_ratio;
  json["mean_overlap_ratio"] = p.mean_overlap;
  json["largest_overlap_ratio"] = p.largest_overlap;
  json["stiffness_level"] = p.stiffness_level;
  json["cell_edges_in_diameters"] = Json::array();
  for (int k = 0; k < p.dimension; ++k) json["cell_edges_in_diameters"].push_back(p.cell_edges[k]);
  return json;
}

void add_proportions(Listing& listing, const Sizes& sizes) {
  listing.add_to_text("proportions", "mean diameter " + in_digits(sizes.mean_diameter, 3) + " m, p " +
                                         in_digits(sizes.pressure, 4) + " Pa, " + in_words(sizes.proportions));
  const Json json = as_json(sizes);
  for (const auto& [key, value] : json.items()) listing.add_to_json(key, value);
}

}  // namespace rvelab::cli
