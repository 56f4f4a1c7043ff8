// What a user wrote: as a message shows it, and without the blanks around it.
#pragma once

#include <string>

namespace rvelab::keys {

/// The first bytes of a text, to the end of a letter of UTF-8, on one line.
inline std::string shortened(const std::string& text, std::size_t most = 60) {
  std::size_t end = text.size() <= most ? text.size() : most;
  while (end < text.size() && end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
  std::string line;
  for (const char letter : text.substr(0, end)) line += letter == '\n' ? std::string("\\n") : std::string(1, letter);
  return line + (end < text.size() ? "..." : "");
}

inline std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

}  // namespace rvelab::keys
