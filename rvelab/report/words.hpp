// Numbers as a page prints them: never more than three significant digits unless an error allows them.
#pragma once

#include <string>

namespace rvelab::report {

/// Three significant digits in plain notation from 1e-3 to 1e5, otherwise with powers of 1000: "32.9", "1.50e6"; "-"
/// for NaN.
std::string in_three_digits(double value);

/// A measured value in a suitable unit: (11.9e6, "Pa") is "11.9 MPa", (0.05, "") is "0.05".
struct InUnit {
  double factor;
  std::string unit;
};
InUnit fitting_unit(double value, const std::string& unit);

/// "30.1 \u00b1 0.4": the error with two digits and the value with the same decimals (ensemble::with_error); three
/// digits without an error.
std::string with_its_error(double value, double error);

/// "29.1 to 31.2", with the digits that half of it allows; "" for NaN.
std::string interval_in_words(double low, double high);

/// "1 test", "3 tests".
std::string counted(std::size_t number, const std::string& what);

}  // namespace rvelab::report
