// Commands of the shell, as a host's developer gives them.
#pragma once

#include <cstdio>
#include <string>

namespace rvelab::test {

/// What a command of the shell prints, its errors too, and its exit code at the end: "...\n0".
inline std::string output_of(const std::string& command) {
  FILE* const pipe = popen(("( " + command + " ) 2>&1").c_str(), "r");
  std::string text;
  char part[4096];
  for (std::size_t size; (size = fread(part, 1, sizeof part, pipe)) > 0;) text.append(part, size);
  return text + "\n" + std::to_string(pclose(pipe));
}

}  // namespace rvelab::test
