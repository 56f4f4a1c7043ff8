#include "rvelab/cli/columns.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "rvelab/io/publish.hpp"

namespace rvelab::cli {
namespace {

/// Letters of a UTF-8 text.
std::size_t letters_of(const std::string& text) {
  return std::size_t(std::count_if(text.begin(), text.end(), [](char byte) { return (byte & 0xC0) != 0x80; }));
}

}  // namespace

std::string aligned(const std::vector<std::vector<std::string>>& rows, std::size_t to_the_left, std::size_t width) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t k = 0; k < row.size(); ++k) widths[k] = std::max(widths[k], letters_of(row[k]));
  }
  const auto padded = [&](const std::vector<std::string>& row, std::size_t k) {
    const std::string blank(widths[k] - letters_of(row[k]), ' ');
    return k < to_the_left ? row[k] + blank : blank + row[k];
  };
  std::string text;
  for (std::size_t first = 1, end = 1; first < widths.size() || first == 1; first = end) {
    std::size_t length = widths.empty() ? 0 : widths[0];
    while (end < widths.size() && (end == first || length + 2 + widths[end] <= width)) length += 2 + widths[end++];
    for (const auto& row : rows) {
      std::string line = row.empty() ? "" : padded(row, 0);
      for (std::size_t k = first; k < std::min(end, row.size()); ++k) line += "  " + padded(row, k);
      text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    }
    if (end < widths.size()) text += "\n";
    if (end == first) break;
  }
  return text;
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char letter : text) quoted += letter == '"' ? std::string("\"\"") : std::string(1, letter);
  return quoted + "\"";
}

std::string csv_cell(double value) { return std::isfinite(value) ? io::exact(value) : ""; }

namespace {

/// Rounded to so many digits, in powers of a thousand from 1e5 on, as ensemble::with_error has them.
std::string with_digits(double value, int digits, bool zeros) {
  if (!std::isfinite(value)) return std::isnan(value) ? "-" : value > 0 ? "inf" : "-inf";
  if (value == 0) return "0";
  char text[64];
  std::snprintf(text, sizeof text, "%.*e", digits - 1, value);
  const int place = std::atoi(std::strchr(text, 'e') + 1);
  const int power = place >= 5 ? 3 * (place / 3) : place < -4 ? place : 0;
  std::snprintf(text, sizeof text, "%.*f", std::max(0, digits - 1 - (place - power)), value / std::pow(10.0, power));
  std::string number = text;
  if (!zeros && number.find('.') != std::string::npos) {
    number.erase(number.find_last_not_of('0') + 1);
    if (number.back() == '.') number.pop_back();
  }
  return number + (power == 0 ? "" : "e" + std::to_string(power));
}

}  // namespace

std::string in_digits(double value, int digits) { return with_digits(value, digits, false); }

std::string angle_in_digits(double degrees) { return with_digits(degrees, 3, true); }

std::string two_digits(double value) { return with_digits(value, 2, true); }

}  // namespace rvelab::cli
