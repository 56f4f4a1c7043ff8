// What a command prints: one JSON object with --json, a plain listing "key  value unit" otherwise.
#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "rvelab/measure/proportions.hpp"

namespace rvelab::cli {

using Json = nlohmann::ordered_json;

/// Indented, ends with a newline; what is no UTF-8 becomes a replacement character.
std::string json_text(const Json& json);
/// An array of numbers; null is NaN.
std::vector<double> numbers_in(const Json& row);

/// Results of a command, in the order in which they were added. JSON keeps every bit of a number; the listing shows
/// four digits, of angles three. NaN means not defined: null in JSON, "-" in the listing. Arrays are row-major.
class Listing {
 public:
  /// `value`: number, text, boolean, array or object. `unit` stands in the listing only ("" for none); JSON keys end in
  /// their unit.
  void add(const std::string& key, Json value, const std::string& unit = "");
  /// A line of the listing only, or of JSON only.
  void add_to_text(const std::string& key, const std::string& text) { lines_.push_back({key, text, "", Form::text}); }
  void add_to_json(const std::string& key, Json value) { lines_.push_back({key, std::move(value), "", Form::json}); }
  /// A number that may not be defined: where it is NaN, `why` stands in its place in the listing, and in the object
  /// "undefined" of the JSON, by the key.
  void add_or_why(const std::string& key, double value, const std::string& unit, const std::string& why);
  bool empty() const { return lines_.empty(); }
  std::string json() const;  ///< one object, indented, ends with a newline
  std::string text() const;  ///< one line a key; matrices and lists of objects one line a row
  /// Prints to standard output in the one form or the other.
  void print(bool as_json) const;

 private:
  enum class Form { both, text, json };
  struct Line {
    std::string key;
    Json value;
    std::string unit;
    Form form = Form::both;
  };
  std::vector<Line> lines_;
  Json undefined_ = Json::object();  ///< reasons by key
};

/// A remark or warning: one line on standard error, "rvelab: text".
void tell(const std::string& text);

/// A matrix as an array of rows.
Json row_major(const Eigen::MatrixXd& matrix);

/// Proportions of a specimen, and the two quantities that reveal a wrong unit.
struct Sizes {
  Proportions proportions;
  double mean_diameter = 0;  ///< m
  double pressure = 0;       ///< Pa, of the contact stress
};
Sizes sizes_of(const Network& network);

/// Adds them: one line in the listing, a key for each in JSON.
void add_proportions(Listing& listing, const Sizes& sizes);
/// Those keys.
Json as_json(const Sizes& sizes);

}  // namespace rvelab::cli
