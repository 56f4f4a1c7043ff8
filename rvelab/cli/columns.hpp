// Tables of text, and numbers in the digits that mean something.
#pragma once

#include <string>
#include <vector>

namespace rvelab::cli {

/// Columns as wide as their widest cell, two blanks apart. A row that would be longer than `width` is continued in a
/// second table below, which repeats the first column.
std::string aligned(const std::vector<std::vector<std::string>>& rows, std::size_t width = 120);

/// A value in the digits that its error, or half of its interval, leaves it (ensemble::with_error).
std::string in_digits_of(double value, double error);

/// Two significant digits; "-" for NaN.
std::string two_digits(double value);

}  // namespace rvelab::cli
