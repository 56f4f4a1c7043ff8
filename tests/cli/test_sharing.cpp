// Tests shared by ranks, which a launcher names in the environment; tests/ranks/mpirun does the same under mpirun.
#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

constexpr const char* brief = " --set stage.compression.to_strain=0.01 --set test.pressure_Pa=20e3 ";

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
  const Outcome ranks = shell(here, as_rank(2, 3, test + "shared", "&\n") + as_rank(1, 3, test + "shared", "&\n") +
                                        as_rank(0, 3, test + "shared", "\n") + "first=$?; wait; exit $first");
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

TEST_CASE("The first rank takes over the test of a rank that is killed") {
  Workplace here;
  here.import_packing("dense_p20", "S_a.h5");
  here.import_packing("medium_p20", "S_b.h5");
  const std::string test =
      "calibrate biaxial --pressures 20e3 --set stage.compression.to_strain=0.03 S_a.h5 S_b.h5 -o ";
  REQUIRE(here.run(test + "alone").code == 0);
  // The second rank begins with the second specimen, and is killed once that is in its hands.
  const Outcome ranks = shell(
      here, "exec_rank() { exec env " + as_rank(1, 2, test + "shared --threads 1") + "; }\nexec_rank & second=$!\n" +
                "while [ ! -s shared/R_20000_2.h5.journal ]; do sleep 0.01; done\nkill -9 $second\n" +
                as_rank(0, 2, test + "shared --threads 1"));
  INFO(bytes_of(here / "rank0.err"));
  REQUIRE(ranks.code == 0);
  CHECK(bytes_of(here / "shared/summary.json") == bytes_of(here / "alone/summary.json"));
}

TEST_CASE("A single test runs on the first rank alone") {
  Workplace here;
  here.import_packing("dense_p20", "S_a.h5");
  const std::string test = std::string("run biaxial --specimen S_a.h5") + brief + "-o R.h5 --json";
  REQUIRE(shell(here, as_rank(1, 2, test)).code == 0);
  CHECK(bytes_of(here / "rank1.out").empty());
  CHECK_FALSE(std::filesystem::exists(here / "R.h5"));
  REQUIRE(shell(here, as_rank(0, 2, test)).code == 0);
  CHECK(std::filesystem::exists(here / "R.h5"));
}

TEST_CASE("Ranks without a folder for the records, or told to overwrite, are refused") {
  Workplace here;
  here.import_packing("dense_p20", "S_a.h5");
  here.import_packing("medium_p20", "S_b.h5");
  const std::string test = std::string("run biaxial --specimen 'S_*.h5'") + brief;
  CHECK(shell(here, as_rank(0, 4, test)).code == 2);
  CHECK_THAT(bytes_of(here / "rank0.err"), Contains("4 ranks share the tests") && Contains("-o"));
  CHECK(shell(here, as_rank(0, 4, test + "-o D --force")).code == 2);
  CHECK_THAT(bytes_of(here / "rank0.err"), Contains("4 ranks share the tests") && Contains("--force"));
  CHECK_FALSE(std::filesystem::exists(here / "D/R_a.h5"));
}
