// The table of a measured curve as a machine of a laboratory, or a spreadsheet, writes it.
//
// Titles may stand above the header, and units in the row below it. The header is the first line that holds the names
// that are sought, parted by semicolons, tabs, commas or blanks (or by what a first line "sep=;" says); comments may
// hold it. Lines without a number are remarks. Rows may be shorter than the header, or end in empty cells. Text is
// UTF-8, UTF-16 or Latin-1. Numbers: numerals.hpp; what could be read in two ways is refused. A cell that nobody asks
// for is not judged. Every message names file, line, column and value.
#pragma once

#include <deque>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace rvelab::fit {

/// What is known of a header before it is found.
struct KnownHeader {
  std::function<std::size_t(std::span<const std::string>)> recognised;  ///< how many of these cells are names sought
  std::size_t wanted = 2;                                               ///< so many make a header
  std::string allowed;                                                  ///< names, for messages
};

class MeasuredTable {
 public:
  /// `path` serves messages. InputError: no header, no text.
  MeasuredTable(const std::string& path, const std::string& text, const KnownHeader& header);
  MeasuredTable(const MeasuredTable&) = delete;  // cells view the text
  MeasuredTable& operator=(const MeasuredTable&) = delete;

  const std::string& path() const { return path_; }
  std::size_t rows() const { return lines_.size(); }
  const std::vector<std::string>& names() const { return names_; }
  /// The unit below a name, without brackets; "": none.
  const std::string& unit(std::size_t column) const { return units_[column]; }
  /// InputError if it is missing, or there twice.
  std::size_t column(const std::string& name) const;
  bool is_empty(std::size_t row, std::size_t column) const { return cell(row, column).empty(); }
  /// Whether the line ends before this column.
  bool ends_before(std::size_t row, std::size_t column) const { return given_[row] <= column; }

  /// The columns whose numbers will be asked for, before any is: they say together what the decimal mark is.
  void choose(const std::vector<std::size_t>& columns);
  /// InputError: no number, or one of several.
  double number(std::size_t row, std::size_t column) const;
  /// The same; NaN for what number() refuses.
  double number_or_nan(std::size_t row, std::size_t column) const;

  std::string location(std::size_t row, std::size_t column) const;  ///< "path:line: column NAME = VALUE"
  std::string header_location() const { return path_ + ":" + std::to_string(header_line_); }
  /// "lines 2 to 5, 9", of rows that rise.
  std::string lines_in_words(const std::vector<std::size_t>& rows) const;
  /// What was left out beside the rows, a sentence each.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  std::string_view cell(std::size_t row, std::size_t column) const { return cells_[row * names_.size() + column]; }
  std::vector<std::string> names_in(std::string_view line, long number, char delimiter);
  void find_header(const KnownHeader& header);
  void read_rows();
  [[noreturn]] void refuse_length(std::size_t row) const;
  [[noreturn]] void refuse_ambiguous(std::size_t row, std::size_t column, double decimal, double grouped) const;
  /// Whether its commas may group the digits of the large among its numbers, as far as it says itself.
  bool may_group(std::size_t column) const;

  std::string path_, text_;
  char delimiter_ = 0;
  long header_line_ = 0;
  std::deque<std::string> kept_;  // cells that are not in the text as they are
  std::vector<std::string> names_, units_;
  std::vector<std::string_view> cells_;  // row-major
  std::vector<long> lines_;
  std::vector<std::size_t> given_;  // cells of each line
  std::string certain_[2];          // where the decimal mark is a comma, or a point, for certain
  std::string groups_;              // marks that group digits for certain
  std::vector<std::string> notes_;
};

/// Names of columns are the same whatever their case; letters of ASCII.
std::string in_small_letters(std::string text);

/// "lines 2 to 5, 9": of numbers that rise; long lists are cut.
std::string lines_in_words(const std::vector<long>& lines);

}  // namespace rvelab::fit
