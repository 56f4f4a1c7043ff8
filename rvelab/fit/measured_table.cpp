#include "rvelab/fit/measured_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "rvelab/error.hpp"
#include "rvelab/fit/numerals.hpp"
#include "rvelab/io/import/csv_table.hpp"
#include "rvelab/io/import/text.hpp"
#include "rvelab/io/utf8.hpp"
#include "rvelab/keys/shortened.hpp"

namespace rvelab::fit {
namespace {

std::string shown(std::string_view text) { return keys::shortened(io::printable(text)); }

std::string without_brackets(const std::string& unit) {
  const bool bracketed = unit.size() > 1 && (unit.front() == '[' || unit.front() == '(');
  return bracketed ? keys::trimmed(unit.substr(1, unit.size() - 2)) : unit;
}

bool holds_number(std::span<const std::string_view> cells) {
  return std::any_of(cells.begin(), cells.end(), [](auto cell) { return numeral(cell).has_value(); });
}

}  // namespace

std::string in_small_letters(std::string text) {
  for (char& letter : text) letter = letter >= 'A' && letter <= 'Z' ? char(letter - 'A' + 'a') : letter;
  return text;
}

std::string lines_in_words(const std::vector<long>& lines) {
  constexpr std::size_t most = 5;  // runs of lines
  std::string words = lines.size() == 1 ? "line " : "lines ";
  std::size_t runs = 0;
  for (std::size_t k = 0; k < lines.size(); ++runs) {
    std::size_t last = k;
    while (last + 1 < lines.size() && lines[last + 1] == lines[last] + 1) ++last;
    if (runs == most)
      return words + " and " + std::to_string(lines.size() - k) + " more up to " + std::to_string(lines.back());
    words += (k == 0 ? "" : ", ") + std::to_string(lines[k]);
    if (last > k) words += " to " + std::to_string(lines[last]);
    k = last + 1;
  }
  return words;
}

MeasuredTable::MeasuredTable(const std::string& path, const std::string& text, const KnownHeader& header)
    : path_(path), text_(io::as_utf8(text)) {
  if (const auto bad = text_.find('\0'); bad != std::string::npos)
    throw InputError(path + ": holds the byte \\x00 and is no text; allowed: a table as text (CSV); save it so");
  find_header(header);
  read_rows();
}

std::vector<std::string> MeasuredTable::names_in(std::string_view line, long number, char delimiter) {
  std::vector<std::string_view> cells;
  try {
    io::split_cells(line, delimiter, path_, number, kept_, cells);
  } catch (const InputError&) {
    return {};  // a title with the sign of an inch
  }
  while (!cells.empty() && cells.back().empty()) cells.pop_back();
  return {cells.begin(), cells.end()};
}

/// The header: the first line of which enough is recognised; else, for a message about its names, the line of words
/// with most names, or the last before the first numbers.
void MeasuredTable::find_header(const KnownHeader& header) {
  char stated = 0;
  bool begun = false, numbers = false;
  std::size_t best = 0;
  std::string_view first_number;
  long first_number_line = 0;
  std::vector<long> titles;
  for (io::TextLines lines(text_); lines.next();) {
    std::string_view line = io::without_blanks(lines.line());
    if (line.empty()) continue;
    if (!std::exchange(begun, true) && (stated = io::named_separator(line, path_, lines.number())) != 0) continue;
    const auto take = [&](std::vector<std::string> names, char delimiter) {
      names_ = std::move(names);
      delimiter_ = delimiter;
      header_line_ = lines.number();
    };
    const bool is_comment = line.front() == '#';
    line = is_comment ? line.substr(std::min(line.find_first_not_of("# \t"), line.size())) : lines.line();
    std::size_t cells = 0;
    for (const char delimiter : stated != 0 ? std::string(1, stated) : std::string(";\t, ")) {
      if (line.find(delimiter) == std::string_view::npos && delimiter != ',') continue;
      std::vector<std::string> names = names_in(line, lines.number(), delimiter);
      const std::size_t known = header.recognised(names);
      const bool sentence = delimiter == ' ' && 2 * known < names.size();  // that happens to hold a name
      if (known >= header.wanted && !sentence) {
        take(std::move(names), delimiter);
        if (!titles.empty())
          notes_.push_back("the header is line " + std::to_string(header_line_) +
                           "; what stands above it is left out, " + fit::lines_in_words(titles));
        return;
      }
      if (names.empty() || names.size() < cells || is_comment) continue;
      cells = names.size();
      const bool words = std::none_of(names.begin(), names.end(), [](const auto& name) { return numeral(name); });
      const bool all_numbers =
          std::all_of(names.begin(), names.end(), [](const auto& name) { return name.empty() || numeral(name); });
      if (all_numbers && !std::exchange(numbers, true)) {
        first_number = line;
        first_number_line = lines.number();
      }
      if (!words || sentence || known < best || (known == 0 && numbers)) continue;
      if (known == best && names.size() <= names_.size()) continue;
      best = known;
      take(std::move(names), delimiter);
    }
    if (!is_comment) titles.push_back(lines.number());
  }
  if (!names_.empty()) return;
  throw InputError(path_ + (numbers ? ":" + std::to_string(first_number_line) : "") + ": has no header line" +
                   (numbers ? " before its numbers, " + shown(first_number) : "") + "; allowed: column names, " +
                   header.allowed + ", then rows of numbers; write the names above them");
}

void MeasuredTable::read_rows() {
  units_.resize(names_.size());
  std::vector<long> remarks;
  std::vector<std::string_view> cells;
  bool units = false;
  for (io::TextLines lines(text_); lines.next();) {
    const std::string_view line = io::without_blanks(lines.line());
    if (lines.number() <= header_line_ || line.empty() || line.front() == '#') continue;
    cells.clear();
    io::split_cells(lines.line(), delimiter_, path_, lines.number(), kept_, cells);
    const std::size_t stated = std::min(cells.size(), names_.size());
    while (!cells.empty() && cells.back().empty()) cells.pop_back();  // ";;;", as spreadsheets end a row
    if (cells.empty()) continue;
    if (!holds_number(cells)) {
      if (rows() > 0 || std::exchange(units, true)) {
        remarks.push_back(lines.number());
        continue;
      }
      for (std::size_t k = 0; k < std::min(cells.size(), names_.size()); ++k)
        units_[k] = without_brackets(std::string(cells[k]));
      continue;
    }
    lines_.push_back(lines.number());
    given_.push_back(std::max(cells.size(), stated));
    cells.resize(names_.size());
    cells_.insert(cells_.end(), cells.begin(), cells.end());
  }
  if (!remarks.empty()) notes_.push_back("without a number, and left out: " + fit::lines_in_words(remarks));
}

std::size_t MeasuredTable::column(const std::string& name) const {
  for (const bool exact : {true, false}) {
    std::optional<std::size_t> found;
    for (std::size_t k = 0; k < names_.size(); ++k) {
      if (exact ? names_[k] != name : in_small_letters(names_[k]) != in_small_letters(name)) continue;
      if (found)
        throw InputError(header_location() + ": the header has the column " + shown(name) + " twice, as columns " +
                         std::to_string(*found + 1) + " and " + std::to_string(k + 1) + "; allowed: once; rename one");
      found = k;
    }
    if (found) return *found;
  }
  std::string header;
  for (const auto& each : names_) header += (header.empty() ? "" : ", ") + each;
  throw InputError(header_location() + ": the column " + shown(name) + " is missing; the header is " +
                   keys::shortened(io::printable(header), 200) + "; name a column of it");
}

void MeasuredTable::choose(const std::vector<std::size_t>& columns) {
  for (const std::size_t column : columns)
    for (std::size_t row = 0; row < rows(); ++row) {
      const auto read = numeral(cell(row, column));
      if (!read) continue;
      if (read->certain && certain_[read->mark == '.'].empty()) certain_[read->mark == '.'] = location(row, column);
      if (read->groups != 0 && groups_.find(read->groups) == std::string::npos) groups_ += read->groups;
    }
}

bool MeasuredTable::may_group(std::size_t column) const {
  bool whole = false;
  for (std::size_t row = 0; row < rows(); ++row) {
    const auto read = numeral(cell(row, column));
    if (read && read->certain) return false;
    whole |= read && read->mark == 0 && std::abs(read->value) >= 1;
  }
  return whole;
}

void MeasuredTable::refuse_length(std::size_t row) const {
  const bool twice = delimiter_ == ',' && given_[row] == 2 * names_.size();
  throw InputError(
      path_ + ":" + std::to_string(lines_[row]) + ": the row has " + std::to_string(given_[row]) +
      " cells; allowed: one for each of the header's " + std::to_string(names_.size()) + " columns; " +
      (twice ? "if these are decimal commas, part the columns by semicolons or write points" : "complete the row"));
}

void MeasuredTable::refuse_ambiguous(std::size_t row, std::size_t column, double decimal, double grouped) const {
  throw InputError(location(row, column) + " may be " + in_words(decimal) + ", with a decimal mark, or " +
                   in_words(grouped) +
                   ", with groups of digits; allowed: numbers without groups of digits; save the "
                   "table so");
}

double MeasuredTable::number(std::size_t row, std::size_t column) const {
  if (given_[row] > names_.size() || (ends_before(row, column))) refuse_length(row);
  const auto read = numeral(cell(row, column));
  if (!read)
    throw InputError(location(row, column) +
                     (is_empty(row, column) ? " is empty; allowed: a number; fill the cell, or remove the row"
                                            : " is not a finite number; allowed: a number; correct the cell, or remove "
                                              "the row"));
  if (read->mark == 0) return read->value;
  const bool comma = !certain_[0].empty(), point = !certain_[1].empty();
  if (comma && point)
    throw InputError(certain_[0] + " has a decimal comma, and " + certain_[1] +
                     " a decimal point; allowed: one of the two in a table; save it with one kind and without groups "
                     "of digits");
  if (read->certain) return read->value;
  const bool is_comma = read->mark == ',';
  if (is_comma ? point : comma) {  // a mark that is not the decimal one
    if (groups_.find(read->mark) != std::string::npos) return read->grouped;
    refuse_ambiguous(row, column, read->value, read->grouped);
  }
  if (is_comma && ((!comma && delimiter_ == ',') || may_group(column)))
    refuse_ambiguous(row, column, read->value, read->grouped);
  return read->value;
}

double MeasuredTable::number_or_nan(std::size_t row, std::size_t column) const {
  try {
    return number(row, column);
  } catch (const InputError&) {
    return std::numeric_limits<double>::quiet_NaN();
  }
}

std::string MeasuredTable::location(std::size_t row, std::size_t column) const {
  const std::string name = names_[column].empty() ? std::to_string(column + 1) : shown(names_[column]);
  return path_ + ":" + std::to_string(lines_[row]) + ": column " + name + " = " + shown(cell(row, column));
}

std::string MeasuredTable::lines_in_words(const std::vector<std::size_t>& rows) const {
  std::vector<long> lines;
  for (const std::size_t row : rows) lines.push_back(lines_[row]);
  return fit::lines_in_words(lines);
}

}  // namespace rvelab::fit
