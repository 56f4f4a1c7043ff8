// Text that people and other programs are shown is UTF-8, whatever bytes a file or a path holds.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace rvelab::io {

/// Bytes that the UTF-8 character at `at` takes (1 to 4); 0 if there is none: a stray or missing continuation, an
/// overlong form, a surrogate, a number beyond U+10FFFF. `at` < text.size().
std::size_t utf8_length(std::string_view text, std::size_t at);

/// Place of the first byte that belongs to no UTF-8 character; npos if there is none.
std::size_t first_non_utf8(std::string_view text);

/// The text with each byte that is no UTF-8, and each control character, written as \xNN.
std::string printable(std::string_view text);

}  // namespace rvelab::io
