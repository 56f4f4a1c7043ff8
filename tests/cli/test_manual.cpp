// The manual page and the completion, which are made of the program's own help.
#include <sstream>

#include "tests/program.hpp"

using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

/// What the completion offers where the last of `words` is being written.
std::string offered(const Workplace& here, const std::string& words, int place) {
  here.write("ask.sh",
             "PATH=$(dirname '" RVELAB_PROGRAM "'):$PATH\nsource '" RVELAB_MANUAL "/rvelab.bash'\nCOMP_WORDS=(" +
                 words + ") COMP_CWORD=" + std::to_string(place) + "\n_rvelab\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n");
  const std::string outcome = here.succeeds("ask.sh", "/bin/bash");
  return outcome;
}

}  // namespace

TEST_CASE("the manual page holds every subcommand with its options") {
  const Workplace here;
  const std::string page = bytes_of(RVELAB_MANUAL "/rvelab.1"), help = here.run("--help").output;
  std::istringstream lines(help.substr(help.find("Subcommands:\n") + 13));
  int subcommands = 0;
  for (std::string line; std::getline(lines, line) && !line.empty(); ++subcommands) {
    std::string name = line.substr(2, line.find(' ', 2) - 2);
    for (std::size_t at = 0; (at = name.find('-', at)) != std::string::npos; at += 2) name.insert(at, "\\");
    CHECK_THAT(page, Contains(".SS " + name + "\n"));
  }
  CHECK(subcommands > 0);
  CHECK_THAT(page, Contains("\\-\\-checkpoint\\-every"));
}

TEST_CASE("bash completes subcommands, options, names of protocols and files") {
  const Workplace here;
  here.write("dense.h5", "");
  CHECK(offered(here, "rvelab cali", 1) == "calibrate\n");
  CHECK(offered(here, "rvelab run --che", 2) == "--checkpoint-every\n");
  CHECK_THAT(offered(here, "rvelab run biaxial_und", 2), Contains("biaxial_undrained\n"));
  CHECK(offered(here, "rvelab inspect den", 2) == "dense.h5\n");
}
