// What import_csv reads: tables (csv_table.cpp), dumps of LAMMPS, META.json, and the contacts of a packing.
//
// A table has a header line and is read whole; cells are asked for by row and column name.
// Text is UTF-8, with or without a byte order mark, lines end in LF or CRLF. Cells are apart by commas, or by
// semicolons where the header has those and no commas; numbers then may have a decimal comma. Cells may stand in
// quotation marks, doubled inside. Names of columns are found whatever their case. Lines that begin with '#' and empty
// lines are skipped. Every message names file, line, column and value.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rvelab/cell/cell.hpp"
#include "rvelab/specimen/specimen.hpp"

namespace rvelab::io {

class CsvTable {
 public:
  /// Reads a file. InputError: missing, no UTF-8, no header, a row with another number of cells than the header, an
  /// open quotation mark, a column name twice.
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
  template <class Put>
  void split(std::string_view line, long number, Put put);
  void read_header(std::string_view line, long number);
  /// Index of a column by its name, else by its name in another case; columns_.size(): none.
  std::size_t index_of(const std::string& name) const;

  std::string path_, content_;
  char delimiter_ = ',';
  std::deque<std::string> unquoted_;  // cells that are not in content_ as they are
  std::vector<std::string> columns_;
  std::vector<std::string_view> cells_;  // row-major
  std::vector<long> lines_;              // line number of each row
};

/// The last timestep of a dump.
struct LammpsDump {
  int dimension;  ///< 2 if every z is the same, as in a 2D simulation, else 3
  Matrix3 cell;   ///< m, cell vectors as columns, upper triangular; 2D: (2, 2) is the box' thickness
  /// Columns as in ITEM: ATOMS, but xu, xs and xsu are x (m) there, and diameter is radius; places name the dump's
  /// lines.
  std::unique_ptr<CsvTable> atoms;
};

/// Whether a text begins as a dump does.
bool is_lammps_dump(const std::string& text);

/// Takes a dump in SI units apart; `path` serves the messages. InputError naming the line: not a dump, no box, a box
/// that is not periodic.
LammpsDump read_lammps_dump(const std::string& path, const std::string& text);

/// Contents of META.json. InputError: a missing key that is not optional, one of the wrong kind or out of range.
struct Meta {
  int dimension;
  std::optional<Matrix3> cell;      ///< m, cell vectors as columns, laboratory frame; 2D: (2, 2) is the thickness
  std::optional<double> thickness;  ///< m, 2D
  double reference_pressure;        ///< Pa, 0 if the file has none
  std::optional<std::size_t> particles, contacts;  ///< rows that the tables beside it have
};

/// Reads the file; with `parameters`, sets the material, law and rolling of the specimen from it.
Meta read_meta(const std::string& path, Specimen& specimen, bool parameters);

/// Reads the contacts of a specimen whose grains, cell and parameters stand; `wraps` holds each grain's wrapping
/// translation. Errors as import_csv.
void read_contacts(const CsvTable& table, const std::vector<Image>& wraps, Specimen& specimen);

}  // namespace rvelab::io
