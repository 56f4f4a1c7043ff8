// Names of a table's columns: of its header, of the comments before it, or of the number of columns. Declared in
// csv_table.hpp.
#include <algorithm>
#include <set>

#include "rvelab/error.hpp"
#include "rvelab/io/import/csv_table.hpp"
#include "rvelab/io/utf8.hpp"
#include "rvelab/keys/shortened.hpp"

namespace rvelab::io {
namespace {

std::string lower(std::string_view text) {
  std::string small(text);
  for (char& letter : small) letter = letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
  return small;
}

/// Which of the marks parts the cells of a line: the first that it holds outside of quotation marks.
char delimiter_of(std::string_view line, std::string_view marks) {
  std::string plain;
  bool open = false;
  for (const char letter : without_blanks(line)) {
    open = open != (letter == '"');
    if (!open) plain += letter;
  }
  for (const char mark : marks) {
    if (plain.find(mark) != std::string::npos) return mark;
  }
  return ',';
}

/// A comment without its marks.
std::string_view spoken(std::string_view comment) {
  return without_blanks(comment.substr(std::min(comment.find_first_not_of('#'), comment.size())));
}

std::vector<std::string> names_in(std::string_view text, std::string_view marks) {
  std::vector<std::string> names;
  for (std::size_t begin = text.find_first_not_of(marks); begin < text.size();) {
    const auto end = std::min(text.find_first_of(marks, begin), text.size());
    names.emplace_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(marks, end);
  }
  return names;
}

/// The last comment that has a word for each of so many columns, none of them a number.
std::vector<std::string> names_in_comments(const std::vector<std::string_view>& comments, std::size_t columns) {
  for (auto comment = comments.rbegin(); comment != comments.rend(); ++comment) {
    if (first_non_utf8(*comment) != std::string_view::npos) continue;
    auto names = names_in(spoken(*comment), " \t,;");
    if (names.size() == columns && std::none_of(names.begin(), names.end(), CsvTable::is_number)) return names;
  }
  return {};
}

}  // namespace

char named_separator(std::string_view line, const std::string& path, long number) {
  while (line.ends_with('\r')) line.remove_suffix(1);
  if (line.starts_with('"') && line.ends_with('"') && line.size() > 1) line = line.substr(1, line.size() - 2);
  if (lower(line.substr(0, 4)) != "sep=") return 0;
  const std::string_view mark = line.substr(4);
  const bool allowed = mark.size() == 1 && std::string_view(",;\t |:").find(mark[0]) != std::string_view::npos;
  if (!allowed) {
    throw InputError(path + ":" + std::to_string(number) + ": sep=" + keys::shortened(printable(mark)) +
                     " names no separator; allowed: one of , ; | : a tab or a blank; correct the line or remove it");
  }
  return mark[0];
}

/// "##PERIODIC:: a b c" of YADE's SpherePack.
void CsvTable::read_comment(std::string_view comment, long number) {
  constexpr std::string_view start = "PERIODIC::";
  std::string_view said = spoken(comment);
  if (!said.starts_with(start)) return;
  std::vector<std::string_view> words;
  split_words(said.substr(start.size()), words);
  Vector3 edges = Vector3::Zero();
  bool right = words.size() == 3;
  for (std::size_t k = 0; k < 3 && right; ++k) right = parsed(words[k], edges[int(k)]) && edges[int(k)] > 0;
  if (!right || !edges.allFinite()) {
    throw InputError(path_ + ":" + std::to_string(number) + ": " + keys::shortened(printable(comment)) +
                     " states no cell; allowed: ##PERIODIC:: and three lengths above 0, in m; correct the line");
  }
  edges_ = edges;
}

bool CsvTable::read_first(std::string_view line, long number, const std::vector<std::string_view>& comments) {
  std::vector<std::string_view> cells;
  const auto are_numbers = [&](char delimiter) {
    delimiter_ = delimiter;
    cells.clear();
    split(line, number, cells);
    while (cells.size() > 1 && cells.back().empty()) cells.pop_back();
    return std::all_of(cells.begin(), cells.end(), CsvTable::is_number);
  };
  bool numbers = false;
  if (delimiter_ != 0) {
    numbers = are_numbers(delimiter_);
  } else {
    // A row of numbers: its commas may be decimal, its tabs stand among blanks.
    numbers = are_numbers(delimiter_of(line, ";\t, "));
    if (!numbers && line.find('"') == std::string_view::npos) numbers = are_numbers(' ');
    if (!numbers) are_numbers(delimiter_of(line, ",;\t "));
  }
  if (numbers) {
    name_columns(cells, number, comments);
  } else {
    columns_.assign(cells.begin(), cells.end());
  }
  expect_one_name_each();
  return numbers;
}

void CsvTable::name_columns(const std::vector<std::string_view>& cells, long number,
                            const std::vector<std::string_view>& comments) {
  constexpr std::string_view format = "format ";
  for (const std::string_view comment : comments) {
    if (!spoken(comment).starts_with(format) || first_non_utf8(comment) != std::string_view::npos) continue;
    columns_ = names_in(spoken(comment).substr(format.size()), "_ \t");
    // Further attributes of the grains follow, whose names a comment may give.
    const bool more = !columns_.empty() && columns_.back() == "attrs" && columns_.size() <= cells.size() + 1;
    if (more) {
      columns_.pop_back();
      const auto all = names_in_comments(comments, cells.size());
      if (all.empty() || !std::equal(columns_.begin(), columns_.end(), all.begin())) {
        columns_.resize(cells.size());
      } else {
        columns_ = all;
      }
    }
    if (columns_.size() == cells.size()) return;
    throw InputError(path_ + ":" + std::to_string(number) + ": the row has " + std::to_string(cells.size()) +
                     " cells; allowed: those of " + keys::shortened(std::string(comment)) + ", " +
                     std::to_string(columns_.size()) + "; correct the format or the row");
  }
  columns_ = names_in_comments(comments, cells.size());
  if (!columns_.empty()) return;
  if (delimiter_ == ' ' || delimiter_ == '\t') {
    if (cells.size() == 4) columns_ = {"x", "y", "z", "r"};
    if (cells.size() == 5) columns_ = {"x", "y", "z", "r", "clumpId"};
    guessed_ = !columns_.empty();
    if (guessed_) return;
  }
  throw InputError(path_ + ":" + std::to_string(number) +
                   ": has no header line before its numbers; allowed: column names, then rows of numbers; add the "
                   "header, \"id,x,y,z,radius\"");
}

void CsvTable::expect_one_name_each() const {
  std::set<std::string_view> names;
  for (const std::string& name : columns_) {
    if (name.empty() || names.insert(name).second) continue;
    throw InputError(path_ + ": the header has the column " + keys::shortened(name) +
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

}  // namespace rvelab::io
