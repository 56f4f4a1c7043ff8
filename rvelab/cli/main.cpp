// The program `rvelab`: its subcommands, and the one place where errors become exit codes. 0: done; 1: the run failed;
// 2: a user's mistake. Every error is one line on standard error.
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "rvelab/cli/commands.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/material_toml.hpp"
#include "rvelab/io/version.hpp"

namespace {

constexpr int run_failed = 1, users_mistake = 2;

/// Several mistakes come as several lines of text; they are put into one.
std::string on_one_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  for (auto end = text.find('\n'); end != std::string::npos; end = text.find('\n', end)) text.replace(end, 1, " | ");
  return text;
}

int fail(int code, const char* message) {
  std::cerr << "rvelab: " << on_one_line(message) << std::endl;
  return code;
}

/// The first argument names a subcommand or is an option; CLI11 would only say that a subcommand is missing.
void expect_subcommand(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return;
  const std::string word = argv[1];
  std::vector<std::string> names;
  std::string list;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_name() == word) return;
    names.push_back(command->get_name());
    list += (list.empty() ? "" : ", ") + names.back();
  }
  throw rvelab::InputError("unknown subcommand " + word + "; the nearest is " + rvelab::nearest(word, names) +
                           "; allowed: " + list + "; see rvelab --help");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("rvelab: granular specimens in a periodic cell, deformed increment by increment", "rvelab");
  app.set_version_flag("--version", std::string("rvelab ") + rvelab::version);
  app.require_subcommand(1);
  rvelab::cli::add_import(app);
  rvelab::cli::add_inspect(app);
  rvelab::cli::add_probe(app);
  rvelab::cli::add_run(app);
  rvelab::cli::add_recover(app);
  rvelab::cli::add_calibrate(app);
  rvelab::cli::add_bench(app);
  try {
    expect_subcommand(app, argc, argv);
    app.parse(argc, argv);
    return 0;
  } catch (const rvelab::cli::Stopped& stopped) {
    return stopped.exit_code;
  } catch (const CLI::Success& help_or_version) {
    return app.exit(help_or_version);
  } catch (const CLI::ParseError& error) {
    const std::string remedy = std::string(error.what()) + "; see rvelab --help";
    return fail(users_mistake, remedy.c_str());
  } catch (const rvelab::InputError& error) {
    return fail(users_mistake, error.what());
  } catch (const std::exception& error) {
    return fail(run_failed, error.what());
  }
}
