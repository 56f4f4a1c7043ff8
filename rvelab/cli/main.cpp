// The program `rvelab`: its subcommands, and the conversion of errors to exit codes. 0: done; 1: the run failed; 2: an
// error of the user. Each error is one line of UTF-8 on standard error that names file and remedy; messages of the
// standard library name neither. No colours.
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include "rvelab/cli/command.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/utf8.hpp"
#include "rvelab/io/version.hpp"

namespace {

constexpr int run_failed = 1, users_mistake = 2;

/// The command line, for messages, also for the one that must not allocate.
int word_count = 0;
char** words = nullptr;

int fail(int code, const std::string& message) {
  std::cerr << "rvelab: " << rvelab::io::message_line(message, {words + std::min(word_count, 1), words + word_count})
            << std::endl;
  return code;
}

/// Prints the message without allocating memory.
int fail_without_memory() {
  std::fputs("rvelab: out of memory", stderr);
  for (int k = 0; k < word_count; ++k) {
    std::fputs(k == 0 ? " in " : " ", stderr);
    const std::string_view word = words[k];
    constexpr std::size_t most = 80;
    for (std::size_t at = 0; at < std::min(word.size(), most);) {
      const std::size_t length = rvelab::io::utf8_length(word, at);
      const bool shown = length > 0 && static_cast<unsigned char>(word[at]) >= 0x20;
      if (shown) std::fwrite(word.data() + at, 1, length, stderr);
      if (!shown) std::fputc('?', stderr);
      at += shown ? length : 1;
    }
  }
  std::fputs("; free memory, raise its limit (ulimit -v), or give fewer grains, records or threads\n", stderr);
  return run_failed;
}

/// An unreachable path is an error of the user; a failing file system is not.
int fail_at_path(const std::filesystem::filesystem_error& error) {
  const bool path_at_fault =
      error.code() == std::errc::filename_too_long || error.code() == std::errc::not_a_directory ||
      error.code() == std::errc::too_many_symbolic_link_levels || error.code() == std::errc::permission_denied ||
      error.code() == std::errc::no_such_file_or_directory || error.code() == std::errc::is_a_directory;
  const std::string remedy = path_at_fault ? "; give the path of a file in a folder that you may use"
                                           : "; check the disk, or choose another path";
  return fail(path_at_fault ? users_mistake : run_failed,
              error.path1().string() + ": cannot be used (" + error.code().message() + ")" + remedy);
}

/// Flushes standard output; the exit code says if that fails, as on a full disc.
int done(int code) {
  if (std::cout.flush() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  return fail(run_failed, "standard output could not be written; free space or send it elsewhere");
}

/// Memory may run out outside any handler: before main, and in destructors of the JSON library, which allocate.
[[noreturn]] void end() {
  try {
    if (const auto error = std::current_exception()) std::rethrow_exception(error);
  } catch (const std::bad_alloc&) {
    ::_exit(fail_without_memory());
  } catch (...) {
  }
  std::abort();
}

/// Before all other initialisers of the program.
[[gnu::constructor(101)]] void catch_the_end() { std::set_terminate(end); }

/// Reads the command line, executes it and returns the exit code. Throws on failure.
int carried_out(int argc, char** argv) {
  using namespace rvelab::cli;
  std::signal(SIGXFSZ, SIG_IGN);  // a file beyond the limit of `ulimit -f` is an error like any other
  CLI::App app("rvelab: granular specimens in a periodic cell, deformed increment by increment", "rvelab");
  app.set_version_flag("--version", std::string("rvelab ") + rvelab::io::version);
  app.require_subcommand(1);
  app.footer(
      "`rvelab SUBCOMMAND --help` explains a subcommand, with examples. A first test:\n"
      "  rvelab pack pack_dense -o dense.h5\n"
      "  rvelab run biaxial --specimen dense.h5 -o R.h5");
  for (const auto add :
       {add_pack,    add_clump,   add_import,    add_inspect,   add_measure, add_probe, add_run,
        add_recover, add_seal,    add_calibrate, add_critical,  add_fit,     add_study, add_sheet,
        add_report,  add_compare, add_export,    add_protocols, add_keys,    add_bench})  // in the order of the help
    add(app);
  if (argc < 2) {
    std::cerr << app.help() << std::flush;
    return users_mistake;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // help or version
    app.exit(asked);
  } catch (const CLI::ParseError& error) {
    refuse(app, error);
  } catch (const Exit& exit) {
    return done(exit.code);
  }
  return done(0);
}

/// The exit code, and on failure one line on standard error.
int answer(int argc, char** argv) {
  try {
    return carried_out(argc, argv);
  } catch (const rvelab::InputError& error) {
    return fail(users_mistake, error.what());
  } catch (const rvelab::Error& error) {
    return fail(run_failed, error.what());
  } catch (const std::bad_alloc&) {
    return fail_without_memory();
  } catch (const std::length_error&) {  // a container longer than any machine's memory
    return fail_without_memory();
  } catch (const std::filesystem::filesystem_error& error) {
    return fail_at_path(error);
  } catch (const std::exception& error) {
    return fail(run_failed, "a fault of rvelab itself (" + std::string(error.what()) +
                                "); please report it with the command and its input files");
  }
}

}  // namespace

int main(int argc, char** argv) {
  word_count = argc;
  words = argv;
  try {
    return answer(argc, argv);
  } catch (const std::bad_alloc&) {
    return fail_without_memory();
  }
}
