#include "rvelab/io/csv_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "rvelab/error.hpp"

namespace rvelab {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r"), last = text.find_last_not_of(" \t\r");
  return first == std::string_view::npos ? std::string_view{} : text.substr(first, last - first + 1);
}

/// Calls `put` with each cell of a line.
template <class Put>
void split(std::string_view line, Put put) {
  for (std::size_t begin = 0;;) {
    const auto comma = line.find(',', begin);
    put(trimmed(line.substr(begin, comma - begin)));
    if (comma == std::string_view::npos) return;
    begin = comma + 1;
  }
}

template <class Value>
bool parse(std::string_view text, Value& value) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

std::string whole_file(const std::string& path) {
  if (!std::filesystem::is_regular_file(path)) throw InputError(path + ": no such file; give the path of a CSV file");
  std::ifstream input(path, std::ios::binary);
  std::ostringstream whole;
  whole << input.rdbuf();
  if (!input) throw InputError(path + ": cannot be read; check that it is not empty and its permissions");
  return std::move(whole).str();
}

}  // namespace

CsvTable::CsvTable(const std::string& path) : CsvTable(path, whole_file(path)) {}

CsvTable::CsvTable(const std::string& path, std::string text) : path_(path), content_(std::move(text)) {
  long line_number = 0;
  std::string_view rest = content_;
  while (!rest.empty()) {
    const auto end = rest.find('\n');
    const std::string_view line = trimmed(rest.substr(0, end));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    ++line_number;
    if (line.empty() || line.front() == '#') continue;
    if (columns_.empty()) {
      split(line, [&](std::string_view cell) { columns_.emplace_back(cell); });
      continue;
    }
    const auto before = cells_.size();
    split(line, [&](std::string_view cell) { cells_.push_back(cell); });
    lines_.push_back(line_number);
    if (cells_.size() - before != columns_.size()) {
      throw InputError(place(rows() - 1) + ": the row has " + std::to_string(cells_.size() - before) +
                       " cells; allowed: one for each of the header's " + std::to_string(columns_.size()) +
                       " columns; complete the row");
    }
  }
  if (columns_.empty()) {
    throw InputError(path + ": has no header line; allowed: column names, then rows of numbers; add the header");
  }
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    if (std::count(columns_.begin(), columns_.end(), columns_[k]) > 1) {
      throw InputError(path + ": the header has the column " + columns_[k] + " twice; allowed: once; rename one");
    }
  }
}

bool CsvTable::has(const std::string& column) const {
  return std::find(columns_.begin(), columns_.end(), column) != columns_.end();
}

std::size_t CsvTable::column(const std::vector<std::string>& names) const {
  for (const auto& name : names) {
    const auto found = std::find(columns_.begin(), columns_.end(), name);
    if (found != columns_.end()) return static_cast<std::size_t>(found - columns_.begin());
  }
  std::string wanted, header;
  for (const auto& name : names) wanted += (wanted.empty() ? "" : " or ") + name;
  for (const auto& name : columns_) header += (header.empty() ? "" : ",") + name;
  throw InputError(path_ + ": the column " + wanted + " is missing; the header is " + header +
                   "; name the column in the header or give the right file");
}

std::string_view CsvTable::text(std::size_t row, std::size_t column) const {
  return cells_[row * columns_.size() + column];
}

double CsvTable::number(std::size_t row, std::size_t column) const {
  double value = 0;
  if (!parse(text(row, column), value) || !std::isfinite(value)) {
    throw InputError(place(row, column) + " is not a finite number; allowed: a number; correct the cell");
  }
  return value;
}

std::int64_t CsvTable::integer(std::size_t row, std::size_t column) const {
  std::int64_t value = 0;
  if (!parse(text(row, column), value)) {
    throw InputError(place(row, column) + " is not a whole number; allowed: a whole number; correct the cell");
  }
  return value;
}

std::string CsvTable::place(std::size_t row) const { return path_ + ":" + std::to_string(lines_[row]); }

std::string CsvTable::place(std::size_t row, std::size_t column) const {
  return place(row) + ": column " + columns_[column] + " = " + std::string(text(row, column));
}

}  // namespace rvelab
