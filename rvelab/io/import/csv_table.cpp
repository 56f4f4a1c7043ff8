// Tables of values in columns: lines, cells, numbers. Names of columns: csv_header.cpp. Declared in csv_table.hpp.
#include "rvelab/io/import/csv_table.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "rvelab/error.hpp"
#include "rvelab/io/utf8.hpp"
#include "rvelab/keys/shortened.hpp"

namespace rvelab::io {
namespace {

/// "1,234" or "1,234,567": a comma that may group digits.
bool may_group_digits(std::string_view cell) {
  if (cell.starts_with('-') || cell.starts_with('+')) cell.remove_prefix(1);
  const auto comma = cell.find(',');
  if (comma == 0 || comma == std::string_view::npos || comma > 3 || cell[0] == '0') return false;
  return cell.size() == comma + 4 && cell.find_first_not_of("0123456789", comma + 1) == std::string_view::npos;
}

}  // namespace

void split_cells(std::string_view line, char delimiter, const std::string& path, long number,
                 std::deque<std::string>& kept, std::vector<std::string_view>& cells) {
  const char* const blanks = delimiter == '\t' ? " \r" : " \t\r";
  if (delimiter == ' ') line = without_blanks(line);
  for (std::size_t begin = 0;;) {
    const auto first = std::min(line.find_first_not_of(blanks, begin), line.size());
    const auto next = [&](std::size_t from) {
      return delimiter == ' ' ? line.find_first_of(" \t", from) : line.find(delimiter, from);
    };
    std::size_t end = next(delimiter == ' ' ? first : begin);
    if (first < line.size() && line[first] == '"') {
      std::string cell;
      std::size_t at = first + 1;
      for (bool open = true; open; ++at) {
        if (at >= line.size()) {
          throw InputError(path + ":" + std::to_string(number) +
                           ": a quotation mark is not closed; allowed: cells in quotation marks on one line; close it");
        }
        const bool doubled = line[at] == '"' && at + 1 < line.size() && line[at + 1] == '"';
        open = line[at] != '"' || doubled;
        if (open) cell += line[at];
        if (doubled) ++at;
      }
      cells.push_back(without_blanks(kept.emplace_back(std::move(cell))));
      end = next(at);
      if (!without_blanks(line.substr(at, end == std::string_view::npos ? end : end - at)).empty()) {
        throw InputError(
            path + ":" + std::to_string(number) +
            ": text follows a closing quotation mark; allowed: the next cell; double the marks inside a cell");
      }
    } else {
      cells.push_back(without_blanks(line.substr(begin, end - begin)));
    }
    if (end == std::string_view::npos) return;
    begin = delimiter == ' ' ? line.find_first_not_of(" \t", end) : end + 1;
  }
}

bool CsvTable::is_number(std::string_view cell) {
  double value = 0;
  if (cell.find(',') == std::string_view::npos) return parsed(cell, value);
  std::string with_point(cell);
  std::replace(with_point.begin(), with_point.end(), ',', '.');
  return parsed(std::string_view(with_point), value);
}

CsvTable::CsvTable(const std::string& path) : CsvTable(path, whole_text(path, "a CSV file")) {}

CsvTable::CsvTable(const std::string& path, std::string text)
    : path_(path), text_(std::make_shared<const std::string>(std::move(text))) {
  constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
  std::string_view rest = *text_;
  if (rest.starts_with(byte_order_mark)) rest.remove_prefix(byte_order_mark.size());
  read_lines(rest);
  if (columns_.empty()) {
    throw InputError(path + ": has no header line; allowed: column names, then rows of numbers; add the header");
  }
  expect_one_decimal_mark();
}

CsvTable::CsvTable(const std::string& path, Text text, std::vector<std::string> columns)
    : path_(path), text_(std::move(text)), delimiter_(' '), columns_(std::move(columns)) {}

void CsvTable::add_row(long line, std::span<const std::string_view> cells) {
  cells_.insert(cells_.end(), cells.begin(), cells.end());
  lines_.push_back(line);
}

void CsvTable::read_lines(std::string_view text) {
  std::vector<std::string_view> comments;
  bool begun = false;
  for (TextLines lines(text); lines.next();) {
    const std::string_view line = without_blanks(lines.line());
    if (line.empty()) continue;
    if (line.front() == '#') {
      if (columns_.empty()) {
        comments.push_back(line);
        read_comment(line, lines.number());
      }
      continue;
    }
    if (const auto bad = first_non_utf8(line); bad != std::string_view::npos) {
      throw InputError(path_ + ":" + std::to_string(lines.number()) + ": holds the byte " +
                       printable(line.substr(bad, 1)) +
                       ", which is no UTF-8; allowed: text in UTF-8; save the file so, or give one that is undamaged");
    }
    if (columns_.empty()) {
      if (!std::exchange(begun, true) && (delimiter_ = named_separator(lines.line(), path_, lines.number())) != 0)
        continue;
      if (!read_first(lines.line(), lines.number(), comments)) continue;
    }
    read_row(lines.line(), lines.number());
  }
}

void CsvTable::read_row(std::string_view line, long number) {
  const auto before = cells_.size();
  split(line, number, cells_);
  const auto row = std::span(cells_).subspan(before);
  if (std::all_of(row.begin(), row.end(), [](auto cell) { return cell.empty(); })) {
    return cells_.resize(before);  // ";;;", as spreadsheets end a sheet
  }
  while (cells_.size() - before > columns_.size() && cells_.back().empty()) cells_.pop_back();
  lines_.push_back(number);
  const auto found = cells_.size() - before;
  if (found == columns_.size()) return;
  std::string remedy = "complete the row";
  if (delimiter_ == ',' && found == 2 * columns_.size())
    remedy = "if these are decimal commas, part the columns by semicolons or write points";
  throw InputError(location(rows() - 1) + ": the row has " + std::to_string(found) +
                   " cells; allowed: one for each of the header's " + std::to_string(columns_.size()) + " columns; " +
                   remedy);
}

std::string_view CsvTable::text(std::size_t row, std::size_t column) const {
  return cells_[row * columns_.size() + column];
}

double CsvTable::number(std::size_t row, std::size_t column) const {
  double value = 0;
  std::string_view cell = text(row, column);
  std::string with_point;
  if (cell.find(',') != std::string_view::npos) {
    if (delimiter_ == ',' && may_group_digits(cell)) {
      throw InputError(location(row, column) +
                       " may be a decimal comma or groups of digits; allowed: a number; write a decimal point");
    }
    with_point = cell;
    std::replace(with_point.begin(), with_point.end(), ',', '.');  // "1.000,5" then is no number, as it should be
    cell = with_point;
  }
  if (!parsed(cell, value) || !std::isfinite(value)) {
    throw InputError(location(row, column) + " is not a finite number; allowed: a number; correct the cell");
  }
  return value;
}

double CsvTable::length(std::size_t row, std::size_t column) const {
  const double value = number(row, column);
  return metres_ == 1 ? value : value * metres_;
}

std::int64_t CsvTable::integer(std::size_t row, std::size_t column) const {
  std::int64_t value = 0;
  if (parsed(text(row, column), value)) return value;
  // Scripts write whole numbers as 12.0 or 1e+06, too.
  double decimal = 0;
  constexpr double exact_up_to = 9007199254740992;
  if (parsed(text(row, column), decimal) && std::abs(decimal) <= exact_up_to && decimal == std::trunc(decimal)) {
    return std::int64_t(decimal);
  }
  throw InputError(location(row, column) + " is not a whole number; allowed: a whole number; correct the cell");
}

std::string CsvTable::location(std::size_t row) const { return path_ + ":" + std::to_string(lines_[row]); }

std::string CsvTable::location(std::size_t row, std::size_t column) const {
  const std::string name = columns_[column].empty() ? std::to_string(column + 1) : keys::shortened(columns_[column]);
  return location(row) + ": column " + name + " = " + keys::shortened(std::string(text(row, column)));
}

/// Where some cells have a decimal comma and others a decimal point, one of the two groups digits.
void CsvTable::expect_one_decimal_mark() const {
  const auto first_with = [&](char mark) {
    return std::find_if(cells_.begin(), cells_.end(), [&](std::string_view cell) {
      return cell.find(mark) != std::string_view::npos && is_number(cell);
    });
  };
  const auto comma = first_with(',');
  if (comma == cells_.end()) return;
  const auto point = first_with('.');
  if (point == cells_.end()) return;
  const auto place_of = [&](auto cell) {
    const auto index = std::size_t(cell - cells_.begin());
    return location(index / columns_.size(), index % columns_.size());
  };
  throw InputError(place_of(comma) + " has a decimal comma, and " + place_of(point) +
                   " a decimal point; allowed: one of the two in a table; save it with one kind and without groups of "
                   "digits");
}

}  // namespace rvelab::io
