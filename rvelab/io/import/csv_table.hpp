// A table of values in columns, as spreadsheets, scripts and other programs write it; read whole, cells are asked for
// by row and column name. Positions and contacts come this way; so do the atoms of dumps and data files, whose readers
// fill one row by row. Measured curves are read with more forbearance (fit/measured_table.hpp).
//
// Text is UTF-8, with or without a byte order mark, lines end in LF or CRLF. The header names the columns. Cells are
// apart by commas, or by semicolons, tabs or blanks where the header has those and no commas, or by what a first line
// "sep=;" says. Numbers may have a decimal comma; a table with both a decimal comma and a decimal point is refused,
// since one of the two then groups digits. Cells may stand in quotation marks, doubled inside. Names of columns are
// found whatever their case. Lines that begin with '#', empty lines, and lines and columns of empty cells are skipped.
//
// Where the first line is one of numbers, the header is sought in the comments before it: "#format x_y_z_r" of YADE's
// export.text, or the names alone ("# x y z r", as numpy writes them). Without it, four columns apart by blanks are
// x, y, z, r, and a fifth clumpId, as YADE's SpherePack writes them; its line "##PERIODIC:: a b c" states a cell.
// Every message names file, line, column and value.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rvelab/cell/cell.hpp"
#include "rvelab/io/import/text.hpp"

namespace rvelab::io {

/// Appends the cells of a line, apart by `delimiter` (' ': any number of blanks), without quotation marks. `kept` holds
/// those that are not in the line as they are; path and number serve the messages. InputError for an open quotation
/// mark, and for text behind a closing one.
void split_cells(std::string_view line, char delimiter, const std::string& path, long number,
                 std::deque<std::string>& kept, std::vector<std::string_view>& cells);
/// The mark that a line "sep=;" of a spreadsheet names; 0: it is no such line. InputError for a mark that is none.
char named_separator(std::string_view line, const std::string& path, long number);

class CsvTable {
 public:
  /// Reads a file, packed by gzip or not. InputError: missing, no UTF-8, no header, a row with another number of cells
  /// than the header, an open quotation mark, a column name twice, two kinds of decimal marks.
  explicit CsvTable(const std::string& path);
  /// The same of a text; `path` serves the messages only.
  CsvTable(const std::string& path, std::string text);
  /// No rows yet: they are views of `text` that add_row takes.
  CsvTable(const std::string& path, Text text, std::vector<std::string> columns);
  CsvTable(const CsvTable&) = delete;  // cells view the text
  CsvTable& operator=(const CsvTable&) = delete;

  /// A row of line `line`, a cell for each column: views of the text or of what `keep` has kept.
  void add_row(long line, std::span<const std::string_view> cells);
  std::string_view keep(std::string cell) { return kept_.emplace_back(std::move(cell)); }
  /// Lengths are in so many metres.
  void lengths_in(double metres) { metres_ = metres; }
  double metres() const { return metres_; }

  const std::string& path() const { return path_; }
  std::size_t rows() const { return lines_.size(); }
  bool has(const std::string& column) const;
  /// Names in the order of the file; an empty one where the header has none.
  const std::vector<std::string>& columns() const { return columns_; }

  /// Index of the first of these names that the header has. InputError if it has none.
  std::size_t column(const std::vector<std::string>& names) const;

  double number(std::size_t row, std::size_t column) const;         ///< finite, or InputError
  double length(std::size_t row, std::size_t column) const;         ///< m, finite, or InputError
  std::int64_t integer(std::size_t row, std::size_t column) const;  ///< a whole number, or InputError
  std::string_view text(std::size_t row, std::size_t column) const;

  /// "path:line: column NAME = VALUE", for messages about a cell.
  std::string location(std::size_t row, std::size_t column) const;
  /// "path:line", for messages about a row.
  std::string location(std::size_t row) const;

  /// Edges of a rectangular cell, m, where the file states them.
  const std::optional<Vector3>& edges() const { return edges_; }
  /// Whether a cell is a number, with a decimal point or commas.
  static bool is_number(std::string_view cell);
  /// Whether the columns were named by their number alone.
  bool guessed_columns() const { return guessed_; }

 private:
  void split(std::string_view line, long number, std::vector<std::string_view>& cells) {
    split_cells(line, delimiter_, path_, number, kept_, cells);
  }
  void read_lines(std::string_view text);
  /// Takes the first line that is no comment; true if it is a row and not the header.
  bool read_first(std::string_view line, long number, const std::vector<std::string_view>& comments);
  void name_columns(const std::vector<std::string_view>& cells, long number,
                    const std::vector<std::string_view>& comments);
  void read_row(std::string_view line, long number);
  void read_comment(std::string_view comment, long number);
  void expect_one_name_each() const;
  void expect_one_decimal_mark() const;
  /// Index of a column by its name, else by its name in another case; columns_.size(): none.
  std::size_t index_of(const std::string& name) const;

  std::string path_;
  Text text_;
  char delimiter_ = 0;  // 0: not known yet; ' ': any number of blanks
  double metres_ = 1;
  std::deque<std::string> kept_;  // cells that are not in the text as they are
  std::vector<std::string> columns_;
  std::vector<std::string_view> cells_;  // row-major
  std::vector<long> lines_;              // line number of each row
  std::optional<Vector3> edges_;
  bool guessed_ = false;
};

}  // namespace rvelab::io
