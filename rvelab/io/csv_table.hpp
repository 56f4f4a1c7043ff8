// A table of comma-separated values with a header line, read whole; cells are asked for by row and column name.
//
// Lines that begin with '#' and empty lines are skipped. Every message names file, line, column and value.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace rvelab {

class CsvTable {
 public:
  /// Reads a file. InputError: missing, no header, a row with another number of cells than the header, a column name
  /// twice.
  explicit CsvTable(const std::string& path);
  /// The same of a text; `path` serves the messages only.
  CsvTable(const std::string& path, std::string text);
  CsvTable(const CsvTable&) = delete;  // cells view the text
  CsvTable& operator=(const CsvTable&) = delete;

  const std::string& path() const { return path_; }
  std::size_t rows() const { return lines_.size(); }
  bool has(const std::string& column) const;

  /// Index of the first of these names that the header has. InputError if it has none.
  std::size_t column(const std::vector<std::string>& names) const;

  double number(std::size_t row, std::size_t column) const;         ///< finite, or InputError
  std::int64_t integer(std::size_t row, std::size_t column) const;  ///< a whole number, or InputError
  std::string_view text(std::size_t row, std::size_t column) const;

  /// "path:line: column NAME = VALUE", for messages about a cell.
  std::string place(std::size_t row, std::size_t column) const;
  /// "path:line", for messages about a row.
  std::string place(std::size_t row) const;

 private:
  std::string path_, content_;
  std::vector<std::string> columns_;
  std::vector<std::string_view> cells_;  // row-major
  std::vector<long> lines_;              // line number of each row
};

}  // namespace rvelab
