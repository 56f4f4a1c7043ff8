// rvelab report: tests as one HTML page, drawn by ../share/rvelab/plot/report.py beside the program. Declared in
// command.hpp.
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "rvelab/cli/command.hpp"
#include "rvelab/cli/protocol_input.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/publish.hpp"

extern char** environ;

namespace rvelab::cli {
namespace {

namespace fs = std::filesystem;

struct ReportArguments {
  std::vector<std::string> inputs;
  std::string output, title;
  bool force = false, json = false;
};

/// Runs a program that is looked for in the PATH and returns its exit code; 127 where it cannot be started. A quiet one
/// prints nothing. Error if a signal ended it.
int exit_code_of(const std::vector<std::string>& words, bool quiet) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (int descriptor = 1; quiet && descriptor <= 2; ++descriptor)
    posix_spawn_file_actions_addopen(&actions, descriptor, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int failed = posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) return 127;
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) throw std::system_error(errno, std::generic_category());
  if (WIFEXITED(status)) return WEXITSTATUS(status);
  throw Error(words[0] + " was ended by signal " + std::to_string(WTERMSIG(status)) + " while it drew the report");
}

/// The first Python that has the modules of the figures: that of the distribution may stand behind another in the PATH.
std::string python() {
  const char* named = std::getenv("RVELAB_PYTHON");
  const std::vector<std::string> candidates =
      named != nullptr ? std::vector<std::string>{named}
                       : std::vector<std::string>{"python3", "/usr/bin/python3", "/usr/local/bin/python3"};
  std::string list;
  for (const std::string& candidate : candidates) {
    if (exit_code_of({candidate, "-c", "import numpy, h5py, matplotlib"}, true) == 0) return candidate;
    list += (list.empty() ? "" : ", ") + candidate;
  }
  throw InputError("report: no Python here has numpy, h5py and matplotlib (tried " + list +
                   "); apt-get install python3-h5py python3-matplotlib, or let RVELAB_PYTHON name one that has them");
}

void run_report_page(const ReportArguments& arguments) {
  expect_folder_of(arguments.output);
  std::vector<std::string> files;
  for (const std::string& input : arguments.inputs) {
    if (!fs::exists(input))
      throw InputError(input +
                       ": is not there; give record files that rvelab run -o or calibrate -o wrote, or their folder");
    if (!fs::is_directory(input)) files.push_back(input);
  }
  io::expect_output(arguments.output, arguments.force, files);
  const fs::path program = fs::read_symlink("/proc/self/exe");
  const fs::path script = program.parent_path().parent_path() / "share/rvelab/plot/report.py";
  if (!fs::exists(script)) {
    throw Error(script.string() +
                ": is not there, where this program looks for it; install it anew (cmake --install), "
                "or link to the program rather than copy it");
  }
  ::setenv("RVELAB_PROGRAM", program.c_str(), 1);
  ::setenv("RVELAB_CALLED_AS", "rvelab", 1);
  std::vector<std::string> words{python(), "-B", script.string(), "-o", arguments.output};
  if (!arguments.title.empty()) words.push_back("--title=" + arguments.title);
  if (arguments.json) words.push_back("--json");
  words.push_back("--");
  words.insert(words.end(), arguments.inputs.begin(), arguments.inputs.end());
  if (const int code = exit_code_of(words, false); code != 0) throw Exit(code);
}

}  // namespace

void add_report(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("report", "Draw tests as one HTML page: curves, Mohr circles, chains, film");
  const auto arguments = std::make_shared<ReportArguments>();
  command.add_option("records", arguments->inputs, "record files, or folders of them")->required();
  command.add_option("-o,--output", arguments->output, "page to write, report.html")->required();
  command.add_option("--title", arguments->title, "of the page; default: the names of the tests");
  add_force(command, arguments->force, "an existing page");
  add_json(command, arguments->json);
  command.footer(
      "The page holds all of its figures and loads nothing. Tests that differ by their specimen alone are one curve, "
      "their\n"
      "mean, with a band of one standard deviation. It has a film where a test was run with\n"
      "--set output.snapshots_every=10. Needs a Python with numpy, h5py and matplotlib: RVELAB_PYTHON, python3 or\n"
      "/usr/bin/python3; for the film ffmpeg or Pillow.\n"
      "Examples:\n"
      "  rvelab report R.h5 -o report.html\n"
      "  rvelab report records -o report.html --title \"Dense sand, biaxial tests\"");
  command.callback([arguments] { run_report_page(*arguments); });
}

}  // namespace rvelab::cli
