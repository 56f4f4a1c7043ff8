// The words of a command line, read into the subcommand that they name.
#pragma once

#include <string>
#include <vector>

#include "rvelab/cli/command.hpp"

namespace rvelab::cli {

/// What the words ask for: a command, its options filled in, or a text (help, version).
struct Asked {
  const Command* command = nullptr;
  std::string text;
};

/// What the help of the program itself holds, and its version.
struct About {
  std::string summary, notes, version;
};

/// InputError with the nearest name if a subcommand or an option is not known, with an example if one is missing.
Asked read_words(const std::vector<Command>& commands, const About& about, int argc, const char* const* argv);

/// The help of the program itself.
std::string help_of(const std::vector<Command>& commands, const About& about);

}  // namespace rvelab::cli
