// The subcommands of the program, and what they share.
#pragma once

#include <CLI/CLI.hpp>
#include <exception>
#include <memory>
#include <string>
#include <vector>

namespace rvelab::cli {

/// Ends a command with this exit code; it has printed why. A command that Ctrl-C or SIGTERM stopped: 128 plus the
/// number of the signal.
struct Exit : std::exception {
  explicit Exit(int exit_code) : code(exit_code) {}
  int code;
};

/// The subcommands, one file each: options, help with examples, and what they do when the command line has been read.
/// They throw InputError for a mistake of the user's, Exit for an exit code, anything else if the run failed.
void add_pack(CLI::App&app), add_clump(CLI::App&app), add_import(CLI::App&app), add_inspect(CLI::App&app),
    add_measure(CLI::App&app), add_probe(CLI::App&app), add_run(CLI::App&app), add_recover(CLI::App&app),
    add_seal(CLI::App&app), add_calibrate(CLI::App&app), add_critical(CLI::App&app), add_fit(CLI::App&app),
    add_study(CLI::App&app), add_report(CLI::App&app), add_compare(CLI::App&app), add_export(CLI::App&app),
    add_protocols(CLI::App&app), add_keys(CLI::App&app), add_bench(CLI::App&app);

/// The options that several subcommands have.
void add_json(CLI::App& command, bool& json);
void add_force(CLI::App& command, bool& force, const std::string& what = "an existing file");
void add_threads(CLI::App& command, unsigned& threads, const std::string& help);
void add_set(CLI::App& command, std::vector<std::string>& settings, const std::string& example);

/// InputError of one line for a command line that `app` refused: the nearest name if a subcommand or an option is not
/// known, else what CLI11 says and an example.
[[noreturn]] void refuse(const CLI::App& app, const CLI::ParseError& error);

}  // namespace rvelab::cli
