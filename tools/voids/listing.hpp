// The output of the program: one line per quantity, or one JSON object.
#pragma once

#include <cmath>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>

#include "rvelab/io/utf8.hpp"

namespace rvelab::voids {

class Listing {
 public:
  /// Number, text or list of texts; keys end in their unit, which the lines repeat after the number.
  void add(const std::string& key, nlohmann::ordered_json value, const std::string& unit = "") {
    std::ostringstream text;
    if (value.is_number_float() && std::isnan(value.get<double>()))
      text << "-";
    else if (value.is_number_float())
      text << value.get<double>() << (unit.empty() ? "" : " ") << unit;
    else if (value.is_string())
      text << io::printable(value.get<std::string>());
    else if (value.is_array())
      for (const auto& each : value) text << (text.tellp() > 0 ? "  " : "") << io::printable(each.get<std::string>());
    else
      text << value.dump();
    std::ostringstream line;
    line << std::left << std::setw(34) << key << text.str() << "\n";
    lines_ += line.str();
    object_[key] = std::move(value);
  }
  void print(bool as_json) const {
    using Json = nlohmann::ordered_json;
    std::cout << (as_json ? object_.dump(1, ' ', false, Json::error_handler_t::replace) + "\n" : lines_) << std::flush;
  }

 private:
  nlohmann::ordered_json object_ = nlohmann::ordered_json::object();
  std::string lines_;
};

}  // namespace rvelab::voids
