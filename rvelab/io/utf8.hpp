// Text that people and other programs are shown is UTF-8, whatever bytes a file or a path holds.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace rvelab::io {

/// Bytes that the UTF-8 character at `at` takes (1 to 4); 0 if there is none: a stray or missing continuation, an
/// overlong form, a surrogate, a number beyond U+10FFFF. `at` < text.size().
inline std::size_t utf8_length(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t k) {
    return k < text.size() ? static_cast<unsigned>(static_cast<unsigned char>(text[k])) : 0u;
  };
  const unsigned first = byte(at);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xc2 && first < 0xe0 ? 2 : first >= 0xe0 && first < 0xf0 ? 3 : 4;
  if (first < 0xc2 || first > 0xf4) return 0;
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(at + k) & 0xc0) != 0x80) return 0;
  }
  // The second byte tells overlong forms, surrogates and what lies beyond U+10FFFF.
  const unsigned second = byte(at + 1);
  const bool allowed = (first != 0xe0 || second >= 0xa0) && (first != 0xed || second < 0xa0) &&
                       (first != 0xf0 || second >= 0x90) && (first != 0xf4 || second < 0x90);
  return allowed ? length : 0;
}

/// Place of the first byte that belongs to no UTF-8 character; npos if there is none.
std::size_t first_non_utf8(std::string_view text);

/// The text with each byte that is no UTF-8, and each control character, written as \xNN.
std::string printable(std::string_view text);

/// Several mistakes, one on each line, as one line: " | " between them.
std::string in_one_line(std::string text);

/// An error as the programs print it: one line, printable, and of each word of more than 80 letters (a path, a key, a
/// value) its begin and end, 80 letters in all. `given`: the words of the command line, which may hold blanks and are
/// shortened in the same way where they stand in the message.
std::string message_line(const std::string& text, const std::vector<std::string>& given = {});

}  // namespace rvelab::io
