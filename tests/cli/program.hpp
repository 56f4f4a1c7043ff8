// The program run as a user runs it, in a folder of its own.
#pragma once

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
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

/// A folder that vanishes with the test; commands run with it as the working directory.
class Workplace {
 public:
  std::string operator/(const std::string& name) const { return folder_ / name; }

  Outcome run(const std::string& arguments, const std::string& program = RVELAB_PROGRAM) const {
    const std::string command =
        "cd '" + folder_.path() + "' && '" + program + "' " + arguments + " >.out 2>.err </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, bytes_of(*this / ".out"), bytes_of(*this / ".err")};
  }

  void write(const std::string& name, const std::string& text) const { std::ofstream(*this / name) << text; }

  /// S.h5 from a reference packing of YADE.
  void import_packing(const std::string& name, const std::string& file = "S.h5") const {
    const std::string stem = std::string(RVELAB_TEST_DATA) + "/yade/" + name;
    const Outcome outcome =
        run("import " + stem + ".particles.csv " + stem + ".contacts.csv " + stem + ".json -o " + file);
    INFO(outcome.errors);
    REQUIRE(outcome.code == 0);
  }

 private:
  Folder folder_;
};

/// Exit code 2, nothing on standard output, one line on standard error that holds `part`.
inline void expect_mistake(const Outcome& outcome, const std::string& part) {
  INFO(outcome.errors);
  CHECK(outcome.code == 2);
  CHECK(outcome.output.empty());
  CHECK(outcome.errors.starts_with("rvelab: "));
  CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '\n') == 1);
  CHECK(outcome.errors.find(part) != std::string::npos);
}

}  // namespace rvelab::test
