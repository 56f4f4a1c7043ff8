// Tests shared by processes: --share. A launcher names ranks in the environment; tests/ranks/mpirun does the same under
// mpirun.
#include "tests/program.hpp"

using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

std::string as_rank(int rank, int count, const std::string& arguments, const std::string& after = "") {
  return "OMPI_COMM_WORLD_RANK=" + std::to_string(rank) + " OMPI_COMM_WORLD_SIZE=" + std::to_string(count) + " '" +
         RVELAB_PROGRAM + "' " + arguments + " >rank" + std::to_string(rank) + ".out 2>rank" + std::to_string(rank) +
         ".err " + after;
}

/// A shell that ends with the exit code of the last command.
Outcome shell(const Workplace& here, const std::string& commands) {
  here.write("commands.sh", commands);
  return here.run("commands.sh", "/bin/sh");
}

std::string without_wall(const std::string& text) { return text.substr(0, text.find("wall_s")); }

}  // namespace

TEST_CASE("Ranks share the tests of an ensemble; the first one prints what a single process prints") {
  Workplace here;
  for (const std::string name : {"dense", "medium", "soft"}) here.import_packing(name + "_p20", "S_" + name + ".h5");
  const std::string test = std::string("run biaxial --specimen 'S_*.h5'") + brief + "-o ";
  const Outcome alone = here.run(test + "alone");
  REQUIRE(alone.code == 0);
  const std::string shared = test + "shared --share";
  const Outcome ranks = shell(here, as_rank(2, 3, shared, "&\n") + as_rank(1, 3, shared, "&\n") +
                                        as_rank(0, 3, shared, "\n") + "first=$?; wait; exit $first");
  INFO(bytes_of(here / "rank0.err") << bytes_of(here / "rank1.err"));
  REQUIRE(ranks.code == 0);
  CHECK(bytes_of(here / "shared/summary.json") == bytes_of(here / "alone/summary.json"));
  std::string printed = without_wall(bytes_of(here / "rank0.out"));
  printed.replace(printed.find("shared/R_"), 6, "alone");
  CHECK(printed == without_wall(alone.output));
  for (const std::string rank : {"1", "2"}) {
    CHECK(bytes_of(here / ("rank" + rank + ".out")).empty());
    CHECK(bytes_of(here / ("rank" + rank + ".err")).empty());
  }
  for (const auto& entry : std::filesystem::directory_iterator(here / "shared"))
    CHECK_THAT(entry.path().filename().string(), !Contains("journal"));
}

TEST_CASE("Another rank carries out what it finds, and leaves the summary to the first one") {
  Workplace here;
  here.import_packing("dense_p20", "S_a.h5");
  here.import_packing("medium_p20", "S_b.h5");
  const std::string test = std::string("run biaxial --specimen 'S_*.h5'") + brief + "-o ";
  here.succeeds(test + "alone");
  REQUIRE(shell(here, as_rank(1, 2, test + "shared --share")).code == 0);
  CHECK(std::filesystem::exists(here / "shared/R_a.h5"));
  CHECK(std::filesystem::exists(here / "shared/R_b.h5"));
  CHECK_FALSE(std::filesystem::exists(here / "shared/summary.json"));
  const auto written = std::filesystem::last_write_time(here / "shared/R_b.h5");
  REQUIRE(shell(here, as_rank(0, 2, test + "shared --share")).code == 0);
  CHECK(std::filesystem::last_write_time(here / "shared/R_b.h5") == written);
  CHECK(bytes_of(here / "shared/summary.json") == bytes_of(here / "alone/summary.json"));
}

TEST_CASE("The first rank takes over the test of a rank that is killed") {
  Workplace here;
  here.import_packing("dense_p20", "S_a.h5");
  here.import_packing("medium_p20", "S_b.h5");
  const std::string test = "calibrate biaxial --pressures 20e3 --set stage.compression.to_strain=0.1 S_a.h5 S_b.h5 -o ";
  here.succeeds(test + "alone");
  // The second rank begins with the second specimen, and is killed once that is in its hands.
  const std::string shared = test + "shared --share --threads 1";
  const Outcome ranks =
      shell(here, "second() { exec env " + as_rank(1, 2, shared) + "; }\nsecond & killed=$!\ntries=0\n" +
                      "while [ ! -s shared/R_20000_2.h5.journal ] && [ $tries -lt 2000 ]; do sleep 0.005; "
                      "tries=$((tries + 1)); done\nkill -9 $killed || exit 9\n" +
                      as_rank(0, 2, shared));
  INFO(bytes_of(here / "rank0.err"));
  REQUIRE(ranks.code == 0);
  CHECK(bytes_of(here / "shared/summary.json") == bytes_of(here / "alone/summary.json"));
}

TEST_CASE("A first rank that is stopped says how far the tests are") {
  Workplace here;
  here.import_packing("dense_p20", "S_a.h5");
  here.import_packing("medium_p20", "S_b.h5");
  const std::string test =
      "run biaxial --set stage.compression.to_strain=0.1 --specimen S_a.h5 S_b.h5 -o D --share --threads 1";
  const Outcome outcome = shell(here, as_rank(0, 2, test, "& first=$!\ntries=0\n") +
                                          "while [ ! -s D/R_a.h5.journal ] && [ $tries -lt 2000 ]; do sleep 0.005; "
                                          "tries=$((tries + 1)); done\nkill -TERM $first; wait $first");
  CHECK(outcome.code == 128 + 15);
  CHECK_THAT(bytes_of(here / "rank0.err"), Contains("SIGTERM with 0 of 2 tests"));
  CHECK(shell(here, as_rank(0, 2, test)).code == 0);
}

TEST_CASE("Sharing without a folder, of a single test, or with overwriting is refused") {
  Workplace here;
  here.import_packing("dense_p20", "S_a.h5");
  here.import_packing("medium_p20", "S_b.h5");
  const std::string test = std::string("run biaxial --share") + brief;
  here.refuses(test + "--specimen S_a.h5 S_b.h5", "--share is given without -o");
  here.refuses(test + "--specimen S_a.h5 -o D", "--share is given with one specimen");
  here.refuses(test + "--specimen S_a.h5 S_b.h5 -o D --force", "--force");
  CHECK_FALSE(std::filesystem::exists(here / "D"));
}
