// Text to TOML, the one way for every file and setting. Of hosts that link none of rvelab's modules too, hence without
// a source.
#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>

#include "rvelab/keys/regular_file.hpp"

namespace rvelab::keys {

/// Most names that a dotted key, or the head of a table, may have: each is a table in the one before, and toml++ takes
/// tables apart by recursion, so that 50,000 of them use up the stack. (Brackets in brackets it limits itself.)
inline constexpr int most_names = 8;

/// toml::parse_error where a key has more.
inline void expect_short_keys(std::string_view text) {
  toml::source_index line = 1;
  std::size_t line_begin = 0;
  int dots = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char letter = text[at];
    if (letter == '"' || letter == '\'') {  // to the mark, or the three marks, that close it
      const std::string_view three = text.substr(at, 3);
      const bool long_text = three == std::string_view("\"\"\"") || three == std::string_view("'''");
      const std::string_view mark = long_text ? three : three.substr(0, 1);
      for (at += mark.size(); at < text.size() && text.substr(at, mark.size()) != mark; ++at) {
        if (letter == '"' && text[at] == '\\') ++at;
        if (at >= text.size() || text[at] != '\n') continue;
        if (!long_text) break;  // not closed on its line: a mistake of its own
        ++line;
        line_begin = at + 1;
      }
      if (at < text.size() && text[at] == '\n')
        --at;
      else
        at += mark.size() - 1;
      continue;
    }
    if (letter == '#') {
      at = std::min(text.find('\n', at), text.size()) - 1;
      continue;
    }
    if (letter == '\n') {
      ++line;
      line_begin = at + 1;
    }
    if (letter == '.' && ++dots >= most_names) {
      throw toml::parse_error("a key has more than 8 names with dots between them; give it up to 8",
                              toml::source_position{line, static_cast<toml::source_index>(at + 1 - line_begin)});
    }
    if (std::string_view("\n=[]{},").find(letter) != std::string_view::npos) dots = 0;
  }
}

/// toml::parse, which throws toml::parse_error, for keys of a depth that it can bear.
inline toml::table parse_toml(std::string_view text, std::string_view path = {}) {
  expect_short_keys(text);
  return toml::parse(text, path);
}

/// The same of a file. InputError: missing, no regular file, of more than 16 MiB.
inline toml::table parse_toml_at(const std::string& path) {
  return parse_toml(whole_file<std::string>(path, "a TOML file", 16 << 20), path);
}

}  // namespace rvelab::keys
