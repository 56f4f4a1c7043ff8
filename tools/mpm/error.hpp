// Errors that the user can correct, and how messages print numbers.
#pragma once

#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace mpm {

/// The program prints it in one line and ends with code 2.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

inline std::string text_of(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

inline std::string text_of(const std::vector<double>& values) {
  std::string list;
  for (const double value : values) list += (list.empty() ? "[" : ", ") + text_of(value);
  return list + "]";
}

}  // namespace mpm
