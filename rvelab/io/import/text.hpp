// Texts that import reads: whole, unpacked where they are packed by gzip, and taken apart into lines and words.
#pragma once

#include <charconv>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace rvelab::io {

/// A text that tables view their cells in.
using Text = std::shared_ptr<const std::string>;

/// The text of a file; `wanted`: what messages ask for, "a CSV file". A file of gzip is unpacked, to at most 64 MiB
/// and 40 times its own size: text does not shrink further, and what would is no text. InputError as
/// keys::whole_file, and where the packed file is cut, damaged, beyond that, or packed by another program.
std::string whole_text(const std::string& path, const std::string& wanted);

/// A text as machines under Windows write it, as UTF-8 without a byte order mark: UTF-16 by its mark or its zeros, else
/// Latin-1 where it is no UTF-8. Lines that end in carriage returns alone end in line feeds.
std::string as_utf8(std::string_view text);

inline std::string_view without_blanks(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r"), last = text.find_last_not_of(" \t\r");
  return first == std::string_view::npos ? std::string_view{} : text.substr(first, last - first + 1);
}

/// Whether the whole text is one number; a plus sign may stand before it.
template <class Value>
bool parsed(std::string_view text, Value& value) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

/// The lines of a text one after the other.
class TextLines {
 public:
  /// `number`: that of the first line.
  explicit TextLines(std::string_view text, long number = 1) : rest_(text), next_(number) {}

  /// Goes to the next line; false if there is none.
  bool next() {
    if (rest_.empty()) return false;
    const auto end = rest_.find('\n');
    line_ = rest_.substr(0, end);
    ended_ = end != std::string_view::npos;
    rest_.remove_prefix(ended_ ? end + 1 : rest_.size());
    ++next_;
    return true;
  }
  std::string_view line() const { return line_; }  ///< without its line break; a carriage return is left
  long number() const { return next_ - 1; }
  bool ended() const { return ended_; }            ///< false: the text ends here without a line break
  std::string_view rest() const { return rest_; }  ///< what follows the line

 private:
  std::string_view rest_, line_;
  long next_;
  bool ended_ = true;
};

/// The words of a line, apart by blanks.
inline void split_words(std::string_view line, std::vector<std::string_view>& words) {
  constexpr const char* blanks = " \t\r\f\v";
  words.clear();
  for (auto begin = line.find_first_not_of(blanks); begin != std::string_view::npos;) {
    const auto end = line.find_first_of(blanks, begin);
    words.push_back(line.substr(begin, end - begin));
    begin = end == std::string_view::npos ? end : line.find_first_not_of(blanks, end);
  }
}

}  // namespace rvelab::io
