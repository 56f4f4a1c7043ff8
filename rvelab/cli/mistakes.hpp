// What a user typed against what the program knows: misspelt subcommands and options, and remedies with an example.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace rvelab::cli {

/// InputError naming the nearest subcommand or option if the command line holds one that is not known. CLI11 would
/// report what is missing first, and never what was meant.
void expect_known_words(const CLI::App& app, int argc, const char* const* argv);

/// What an error of CLI11 says, with the subcommand that it is about and an example of its use.
std::string with_remedy(const CLI::App& app, const CLI::Error& error);

}  // namespace rvelab::cli
