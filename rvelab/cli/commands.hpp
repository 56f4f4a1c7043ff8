// The program `rvelab`: one function per subcommand, each in a file of its own. A function adds its subcommand to the
// application; its callback does the work, prints, and throws on failure: InputError (a user's mistake, exit code 2,
// one line on stderr) or any other exception (the run failed, exit code 1). main.cpp alone turns them into codes.
#pragma once

#include <CLI/CLI.hpp>
#include <exception>

namespace rvelab::cli {

/// A command that Ctrl-C or SIGTERM ended after it had put its results away and said so: 128 plus the signal's number.
struct Stopped : std::exception {
  explicit Stopped(int code) : exit_code(code) {}
  int exit_code;
};

void add_import(CLI::App& app);
void add_pack(CLI::App& app);
void add_inspect(CLI::App& app);
void add_probe(CLI::App& app);
void add_run(CLI::App& app);
void add_recover(CLI::App& app);
void add_seal(CLI::App& app);
void add_calibrate(CLI::App& app);
void add_study(CLI::App& app);
void add_compare(CLI::App& app);
void add_export(CLI::App& app);
void add_keys(CLI::App& app);
void add_protocols(CLI::App& app);
void add_bench(CLI::App& app);

}  // namespace rvelab::cli
