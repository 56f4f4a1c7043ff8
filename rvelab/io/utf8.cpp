#include "rvelab/io/utf8.hpp"

#include <algorithm>

namespace rvelab::io {

std::size_t first_non_utf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = utf8_length(text, at);
    if (length == 0) return at;
    at += length;
  }
  return std::string_view::npos;
}

std::string printable(std::string_view text) {
  constexpr char digits[] = "0123456789abcdef";
  std::string shown;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = utf8_length(text, at);
    const auto byte = static_cast<unsigned char>(text[at]);
    if (length > 0 && byte >= 0x20 && byte != 0x7f) {
      shown += text.substr(at, length);
      at += length;
      continue;
    }
    shown += {'\\', 'x', digits[byte >> 4], digits[byte & 15]};
    ++at;
  }
  return shown;
}

std::string in_one_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  for (auto end = text.find('\n'); end != std::string::npos; end = text.find('\n', end)) text.replace(end, 1, " | ");
  return text;
}

namespace {

/// The begin and the end of a text that is printable, with 80 letters in all where it has more.
std::string with_80_letters(std::string_view text) {
  constexpr std::size_t most = 80, first = 45, last = most - 3 - first;
  std::vector<std::size_t> letters;
  for (std::size_t at = 0; at < text.size(); at += std::max<std::size_t>(utf8_length(text, at), 1))
    letters.push_back(at);
  if (letters.size() <= most) return std::string(text);
  return std::string(text.substr(0, letters[first])) + "..." + std::string(text.substr(letters[letters.size() - last]));
}

}  // namespace

std::string message_line(const std::string& text, const std::vector<std::string>& given) {
  std::string whole = in_one_line(text);
  for (const std::string& each : given) {
    const std::string flat = in_one_line(each), shown = with_80_letters(printable(flat));
    if (flat.size() <= 80) continue;
    for (auto at = whole.find(flat); at != std::string::npos; at = whole.find(flat, at + shown.size()))
      whole.replace(at, flat.size(), shown);
  }
  whole = printable(whole);
  std::string line;
  for (std::size_t at = 0; at < whole.size();) {
    const std::size_t end = std::min(whole.find(' ', at), whole.size());
    line += with_80_letters(std::string_view(whole).substr(at, end - at));
    if (end < whole.size()) line += ' ';
    at = end + 1;
  }
  return line;
}

}  // namespace rvelab::io
