// The program run as a user runs it, in a folder of its own.
#pragma once

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/catch.hpp"
#include "tests/folder.hpp"

namespace rvelab::test {

/// Settings of a biaxial test of a second or two.
constexpr const char* brief = " --set stage.compression.to_strain=0.01 --set test.pressure_Pa=20e3 ";

struct Outcome {
  int code;
  std::string output, errors;
};

/// This exit code, and one line on standard error that holds these words: key, value, remedy.
template <class... Words>
void expect_one_line(const Outcome& outcome, int code, const Words&... words) {
  INFO(outcome.errors);
  CHECK(outcome.code == code);
  CHECK(outcome.errors.starts_with("rvelab: "));
  CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '\n') == 1);
  [[maybe_unused]] const auto holds = [&](const std::string& word) {
    CHECK_THAT(outcome.errors, Catch::Matchers::Contains(word));
  };
  (holds(words), ...);
}

/// A user's mistake: exit code 2, and nothing on standard output.
template <class... Words>
void expect_mistake(const Outcome& outcome, const Words&... words) {
  expect_one_line(outcome, 2, words...);
  CHECK(outcome.output.empty());
}

/// A folder that vanishes with the test; commands run with it as the working directory.
class Workplace {
 public:
  std::string operator/(const std::string& name) const { return folder_ / name; }

  /// A line of the shell.
  Outcome shell(const std::string& line) const {
    const std::string command = "cd '" + folder_.path() + "' && { " + line + " ; } >.out 2>.err </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, bytes_of(*this / ".out"), bytes_of(*this / ".err")};
  }
  Outcome run(const std::string& arguments, const std::string& program = RVELAB_PROGRAM) const {
    return shell("'" + program + "' " + arguments);
  }

  /// The output of a command that has to succeed; of one with --json its numbers.
  std::string succeeds(const std::string& arguments, const std::string& program = RVELAB_PROGRAM) const {
    const Outcome outcome = run(arguments, program);
    INFO(arguments << ": " << outcome.errors);
    REQUIRE(outcome.code == 0);
    return outcome.output;
  }
  /// A command that is refused in a line with these words.
  template <class... Words>
  void refuses(const std::string& arguments, const Words&... words) const {
    INFO(arguments);
    expect_mistake(run(arguments), words...);
  }
  nlohmann::json json(const std::string& arguments) const {
    return nlohmann::json::parse(succeeds(arguments + " --json"));
  }

  void write(const std::string& name, const std::string& text) const { std::ofstream(*this / name) << text; }

  /// S.h5 from a reference packing of YADE.
  void import_packing(const std::string& name, const std::string& file = "S.h5") const {
    const std::string stem = std::string(RVELAB_TEST_DATA) + "/yade/" + name;
    succeeds("import " + stem + ".particles.csv " + stem + ".contacts.csv " + stem + ".json -o " + file);
  }

 private:
  Folder folder_;
};

}  // namespace rvelab::test
