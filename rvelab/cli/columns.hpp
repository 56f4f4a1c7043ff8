// Tables of text, and numbers with their significant digits.
#pragma once

#include <string>
#include <vector>

namespace rvelab::cli {

/// Columns as wide as their widest cell, two blanks apart; the first `to_the_left` are aligned left, the others right.
/// A row that would be longer than `width` is continued in a second table below, which repeats the first column.
std::string aligned(const std::vector<std::vector<std::string>>& rows, std::size_t to_the_left = 1000,
                    std::size_t width = 120);

/// A cell of a CSV table: quoted if necessary; the shortest number that reads back, empty for NaN.
std::string csv_cell(const std::string& text);
std::string csv_cell(double value);

/// So many significant digits, without zeros at the end: 0.1874, 83682, 100e3, 35.25e6; "-" for NaN.
std::string in_digits(double value, int digits);

/// An angle, degrees, in three digits: 32.0, as in figures.
std::string angle_in_digits(double degrees);

/// Two significant digits; "-" for NaN.
std::string two_digits(double value);

}  // namespace rvelab::cli
