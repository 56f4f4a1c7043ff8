// Tables of values in columns. Declared in inputs.hpp.
#include "rvelab/io/import/inputs.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "rvelab/error.hpp"
#include "rvelab/io/utf8.hpp"
#include "rvelab/keys/regular_file.hpp"
#include "rvelab/keys/shortened.hpp"

namespace rvelab::io {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r"), last = text.find_last_not_of(" \t\r");
  return first == std::string_view::npos ? std::string_view{} : text.substr(first, last - first + 1);
}

std::string lower(std::string_view text) {
  std::string small(text);
  for (char& letter : small) letter = letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
  return small;
}

template <class Value>
bool parse(std::string_view text, Value& value) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

}  // namespace

CsvTable::CsvTable(const std::string& path) : CsvTable(path, keys::whole_file<std::string>(path, "a CSV file")) {}

/// Calls `put` with each cell of a line, without quotation marks.
template <class Put>
void CsvTable::split(std::string_view line, long number, Put put) {
  for (std::size_t begin = 0;;) {
    const auto first = std::min(line.find_first_not_of(" \t", begin), line.size());
    std::size_t end = line.find(delimiter_, begin);
    if (first < line.size() && line[first] == '"') {
      std::string cell;
      std::size_t at = first + 1;
      for (bool open = true; open; ++at) {
        if (at >= line.size()) {
          throw InputError(path_ + ":" + std::to_string(number) +
                           ": a quotation mark is not closed; allowed: cells in quotation marks on one line; close it");
        }
        const bool doubled = line[at] == '"' && at + 1 < line.size() && line[at + 1] == '"';
        open = line[at] != '"' || doubled;
        if (open) cell += line[at];
        if (doubled) ++at;
      }
      unquoted_.push_back(std::move(cell));
      put(trimmed(unquoted_.back()));
      end = line.find(delimiter_, at);
      if (!trimmed(line.substr(at, end == std::string_view::npos ? end : end - at)).empty()) {
        throw InputError(
            path_ + ":" + std::to_string(number) +
            ": text follows a closing quotation mark; allowed: the next cell; double the marks inside a cell");
      }
    } else {
      put(trimmed(line.substr(begin, end - begin)));
    }
    if (end == std::string_view::npos) return;
    begin = end + 1;
  }
}

void CsvTable::read_header(std::string_view line, long number) {
  delimiter_ = line.find(',') == std::string_view::npos && line.find(';') != std::string_view::npos ? ';' : ',';
  split(line, number, [&](std::string_view cell) { columns_.emplace_back(cell); });
}

CsvTable::CsvTable(const std::string& path, std::string text) : path_(path), content_(std::move(text)) {
  constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
  long line_number = 0;
  std::string_view rest = content_;
  if (rest.starts_with(byte_order_mark)) rest.remove_prefix(byte_order_mark.size());
  while (!rest.empty()) {
    const auto end = rest.find('\n');
    const std::string_view line = trimmed(rest.substr(0, end));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    ++line_number;
    if (line.empty() || line.front() == '#') continue;
    if (const auto bad = first_non_utf8(line); bad != std::string_view::npos) {
      throw InputError(path_ + ":" + std::to_string(line_number) + ": holds the byte " +
                       printable(line.substr(bad, 1)) +
                       ", which is no UTF-8; allowed: text in UTF-8; save the file so, or give one that is undamaged");
    }
    if (columns_.empty()) {
      read_header(line, line_number);
      continue;
    }
    const auto before = cells_.size();
    split(line, line_number, [&](std::string_view cell) { cells_.push_back(cell); });
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
  std::set<std::string_view> names;
  for (const std::string& name : columns_) {
    if (names.insert(name).second) continue;
    throw InputError(path + ": the header has the column " + keys::shortened(name) +
                     " twice; allowed: once; rename one");
  }
}

std::size_t CsvTable::index_of(const std::string& name) const {
  const auto found = std::find(columns_.begin(), columns_.end(), name);
  if (found != columns_.end()) return std::size_t(found - columns_.begin());
  std::size_t index = columns_.size();
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    if (lower(columns_[k]) != lower(name)) continue;
    if (index < columns_.size()) {
      throw InputError(path_ + ": the header has the columns " + columns_[index] + " and " + columns_[k] +
                       "; allowed: one of the two; rename or remove one");
    }
    index = k;
  }
  return index;
}

bool CsvTable::has(const std::string& column) const { return index_of(column) < columns_.size(); }

std::size_t CsvTable::column(const std::vector<std::string>& names) const {
  for (const auto& name : names) {
    if (const auto index = index_of(name); index < columns_.size()) return index;
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
  std::string_view cell = text(row, column);
  std::string with_point;
  if (delimiter_ == ';') {
    with_point = cell;
    std::replace(with_point.begin(), with_point.end(), ',', '.');  // "1.000,5" then is no number, as it should be
    cell = with_point;
  }
  if (!parse(cell, value) || !std::isfinite(value)) {
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
  return place(row) + ": column " + keys::shortened(columns_[column]) + " = " +
         keys::shortened(std::string(text(row, column)));
}

}  // namespace rvelab::io
