// What a user wrote: as a message shows it, and without the blanks around it.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace rvelab::keys {

/// The first bytes of a text, to the end of a letter of UTF-8, on one line.
inline std::string shortened(const std::string& text, std::size_t most = 60) {
  std::size_t end = text.size() <= most ? text.size() : most;
  while (end < text.size() && end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
  std::string line;
  for (const char letter : text.substr(0, end)) line += letter == '\n' ? std::string("\\n") : std::string(1, letter);
  return line + (end < text.size() ? "..." : "");
}

/// A message with its long words cut: of one without blanks that is longer than 80 bytes, such as a name of thousands
/// of letters or a deep path, the first and the last 38 bytes stay. `words`: what a user gave; also cut as a whole.
inline std::string with_short_words(std::string text, const std::vector<std::string>& words = {}) {
  constexpr std::size_t most = 80, part = 38;
  const auto starts_letter = [](char byte) { return (static_cast<unsigned char>(byte) & 0xc0) != 0x80; };
  const auto cut = [&](const std::string& word) {
    std::size_t first = part, last = word.size() - part;
    while (first > 0 && !starts_letter(word[first])) --first;
    while (last < word.size() && !starts_letter(word[last])) ++last;
    return word.substr(0, first) + "..." + word.substr(last);
  };
  for (const std::string& word : words)
    for (auto at = text.find(word); word.size() > most && at != std::string::npos; at = text.find(word, at + most))
      text.replace(at, word.size(), cut(word));
  std::string result;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t blank = std::min(text.find_first_of(" \n", begin), text.size());
    const std::string word = text.substr(begin, blank - begin);
    result += word.size() > most ? cut(word) : word;
    if (blank < text.size()) result += text[blank];
    begin = blank + 1;
  }
  return result;
}

inline std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

}  // namespace rvelab::keys
