// The program `rvelab`: its subcommands, and the one place where errors become exit codes. 0: done; 1: the run failed;
// 2: a user's mistake. Every error is one line on standard error. No colours, on a terminal or off it.
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <new>
#include <string>

#include "rvelab/cli/commands.hpp"
#include "rvelab/cli/mistakes.hpp"
#include "rvelab/error.hpp"
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

/// The exit code of a command whose output has reached its reader: a full disc must not look like success.
int done(int code) {
  if (std::cout.flush() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  return fail(run_failed, "standard output could not be written; free space or send it elsewhere");
}

/// Without asking for more.
int say_out_of_memory() {
  std::fputs("rvelab: out of memory; free some, raise its limit (ulimit -v), or give fewer grains or --threads\n",
             stderr);
  return run_failed;
}

/// Memory may end where no handler is reached: before main, and in destructors of the JSON library, which allocate.
[[noreturn]] void end() {
  try {
    if (const auto error = std::current_exception()) std::rethrow_exception(error);
  } catch (const std::bad_alloc&) {
    ::_exit(say_out_of_memory());
  } catch (...) {
  }
  std::abort();
}

/// Before all other initialisers of the program.
[[gnu::constructor(101)]] void catch_the_end() { std::set_terminate(end); }

/// The program but for what befalls it where not even a subcommand is there yet.
int answer(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file beyond the limit of `ulimit -f` is an error like any other
  CLI::App app("rvelab: granular specimens in a periodic cell, deformed increment by increment", "rvelab");
  app.set_version_flag("--version", std::string("rvelab ") + rvelab::version);
  app.require_subcommand(1);
  rvelab::cli::add_pack(app);
  rvelab::cli::add_import(app);
  rvelab::cli::add_inspect(app);
  rvelab::cli::add_probe(app);
  rvelab::cli::add_run(app);
  rvelab::cli::add_recover(app);
  rvelab::cli::add_seal(app);
  rvelab::cli::add_calibrate(app);
  rvelab::cli::add_compare(app);
  rvelab::cli::add_export(app);
  rvelab::cli::add_protocols(app);
  rvelab::cli::add_keys(app);
  rvelab::cli::add_bench(app);
  rvelab::cli::add_stress_test(app);
  app.footer(
      "rvelab SUBCOMMAND --help says more, with examples. A first test:\n"
      "  rvelab pack pack_dense -o dense.h5\n"
      "  rvelab run biaxial --specimen dense.h5 -o R.h5");
  if (argc < 2) {
    std::cerr << app.help() << std::flush;
    return users_mistake;
  }
  try {
    rvelab::cli::expect_known_words(app, argc, argv);
    app.parse(argc, argv);
    return done(0);
  } catch (const rvelab::cli::Stopped& stopped) {
    return stopped.exit_code;
  } catch (const CLI::Success& help_or_version) {
    return done(app.exit(help_or_version));
  } catch (const CLI::RuntimeError& outcome) {  // a subcommand's own exit code, said by what it printed
    return done(outcome.get_exit_code());
  } catch (const CLI::Error& error) {
    return fail(users_mistake, rvelab::cli::with_remedy(app, error).c_str());
  } catch (const rvelab::InputError& error) {
    return fail(users_mistake, error.what());
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    return fail(run_failed, error.what());
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return answer(argc, argv);
  } catch (const std::bad_alloc&) {
    return say_out_of_memory();
  }
}
