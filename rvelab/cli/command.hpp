// The subcommands of the program, and their common parts.
#pragma once

#include <CLI/CLI.hpp>
#include <exception>
#include <memory>
#include <string>
#include <vector>

namespace rvelab::cli {

/// Ends a command with this exit code, after it has printed the reason. For a command stopped by Ctrl-C or SIGTERM: 128
/// plus the number of the signal.
struct Exit : std::exception {
  explicit Exit(int exit_code) : code(exit_code) {}
  int code;
};

/// The subcommands, one file each: options, help with examples, and the action after the command line has been read.
/// They throw InputError for an error of the user, Exit for an exit code, anything else if the run failed.
void add_pack(CLI::App&app), add_clump(CLI::App&app), add_import(CLI::App&app), add_inspect(CLI::App&app),
    add_measure(CLI::App&app), add_probe(CLI::App&app), add_run(CLI::App&app), add_recover(CLI::App&app),
    add_seal(CLI::App&app), add_calibrate(CLI::App&app), add_critical(CLI::App&app), add_fit(CLI::App&app),
    add_study(CLI::App&app), add_sheet(CLI::App&app), add_report(CLI::App&app), add_compare(CLI::App&app),
    add_export(CLI::App&app), add_protocols(CLI::App&app), add_keys(CLI::App&app), add_bench(CLI::App&app);

/// Common options of several subcommands.
void add_json(CLI::App& command, bool& json);
void add_force(CLI::App& command, bool& force, const std::string& what = "an existing file");
void add_threads(CLI::App& command, unsigned& threads, const std::string& help);
void add_set(CLI::App& command, std::vector<std::string>& settings, const std::string& example);

/// InputError of one line for a command line that `app` rejected: the nearest name for an unknown subcommand or option,
/// otherwise the message of CLI11 and an example.
[[noreturn]] void refuse(const CLI::App& app, const CLI::ParseError& error);

}  // namespace rvelab::cli
