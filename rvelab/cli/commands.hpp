// The program `rvelab`: one function per subcommand, each in a file of its own. A function adds its subcommand to the
// application; its callback does the work, prints, and throws on failure: InputError (a user's mistake, exit code 2,
// one line on stderr) or any other exception (the run failed, exit code 1). main.cpp alone turns them into codes.
#pragma once

#include <CLI/CLI.hpp>

namespace rvelab::cli {

void add_import(CLI::App& app);
void add_inspect(CLI::App& app);
void add_probe(CLI::App& app);
void add_run(CLI::App& app);
void add_calibrate(CLI::App& app);
void add_compare(CLI::App& app);
void add_export(CLI::App& app);
void add_keys(CLI::App& app);
void add_protocols(CLI::App& app);
void add_bench(CLI::App& app);

}  // namespace rvelab::cli
