// What goes wrong outside rvelab is told in its words: one line of UTF-8 with the path and a remedy.
#include <sys/resource.h>

#include <regex>

#include "rvelab/io/utf8.hpp"
#include "tests/program.hpp"

using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

void expect_one_line_of_text(const Outcome& outcome, int code) {
  expect_one_line(outcome, code);
  CHECK(rvelab::io::first_non_utf8(outcome.errors) == std::string::npos);
  for (const char* raw : {"std::", "bad_alloc", "_M_", "filesystem error", "length_error", "what()"})
    CHECK(outcome.errors.find(raw) == std::string::npos);
}

}  // namespace

TEST_CASE("running out of memory is told with the command and a remedy, exit code 1") {
  const Workplace here;
  here.import_packing("dense_p20");
  // A million grains take more than a hundred megabytes.
  Outcome outcome = here.shell("ulimit -v 100000; '" RVELAB_PROGRAM
                               "' pack pack_dense -o big.h5 --threads 1 --set pack.number=1000000");
  CHECK_THAT(outcome.errors, Contains("each trial packing takes"));
  outcome.errors.erase(0, outcome.errors.find('\n') + 1);  // that line
  expect_one_line_of_text(outcome, 1);
  CHECK_THAT(outcome.errors, Contains("out of memory") && Contains("pack.number=1000000") && Contains("ulimit -v"));
  CHECK(!std::filesystem::exists(here / "big.h5"));
}

TEST_CASE("a path that the system does not take is the user's to mend") {
  const Workplace here;
  const std::string endless = std::string(300, 'a') + ".h5";
  const Outcome outcome = here.run("inspect " + endless);
  expect_one_line_of_text(outcome, 2);
  CHECK_THAT(outcome.errors, Contains(" aaaa") && Contains("aa.h5: ") && Contains("; give the path of a file"));
  CHECK(outcome.errors.size() < 250);
}

TEST_CASE("bytes of paths, files and keys that are no UTF-8 are shown as numbers") {
  const Workplace here;
  here.import_packing("dense_p20");
  const std::string bad = "x\xff\x1b[31m";
  expect_one_line_of_text(here.run("inspect '" + bad + ".h5'"), 2);
  CHECK_THAT(here.run("inspect '" + bad + ".h5'").errors, Contains("x\\xff\\x1b[31m.h5: no such file"));
  expect_one_line_of_text(here.run("run biaxial --specimen S.h5 --set 'test.name" + bad + "=1'"), 2);
  expect_one_line_of_text(here.run("run '" + bad + "' --specimen S.h5"), 2);
  // On standard output too.
  std::filesystem::copy_file(here / "S.h5", here / (bad + ".h5"));
  const std::string shown = here.succeeds("inspect '" + bad + ".h5'");
  CHECK(rvelab::io::first_non_utf8(shown) == std::string::npos);
  CHECK_THAT(shown, Contains("x\\xff\\x1b[31m.h5"));
  std::ofstream(here / "p.csv") << "id,x,y,r\n1,0,0,4.66\xd3\n";
  const Outcome table = here.run("import p.csv --cell 1,1,1 -o T.h5");
  expect_one_line_of_text(table, 2);
}

TEST_CASE("a file in another's place is told with what takes it, a probe below round-off with the range") {
  const Workplace here;
  here.import_packing("dense_p20");
  here.refuses("run S.h5 --specimen biaxial", "S.h5 is ", "no protocol", "allowed: ");
  here.refuses("pack S.h5 -o P.h5", "S.h5 is ", "no recipe");
  here.write("C.h5.journal", "");
  here.refuses("compare S.h5 C.h5", "make the file with `rvelab recover C.h5`");
  here.refuses("probe S.h5 --size 1e-30", "--size 1e-30 is out of range; allowed: 1e-12");
  here.refuses("run biaxial --specimen S.h5 --set test.pressure_Pa=1e300", "allowed: 0 to 1e+15 Pa");
}

TEST_CASE("a listing shows what is not defined as a dash, never as a number that is none") {
  const Workplace here;
  // Grains apart: no contact, no fabric, no balance of forces to judge.
  std::ofstream(here / "p.csv") << "ID;X;Y;R\n1;0,1;0,1;0,01\n2;0,5;0,5;0,01\n";
  std::ofstream(here / "m.toml") << "[contact]\nlaw = \"linear\"\n[[material]]\nname = \"sand\"\ndensity_kg_m3 = 2650\n"
                                    "young_modulus_Pa = 1e6\nstiffness_ratio = 0.5\nfriction = 0.5\n";
  here.succeeds("import p.csv --cell 1,1,1 --material m.toml -o S.h5");
  const std::string shown = here.succeeds("inspect S.h5");
  CHECK(shown.find("nan") == std::string::npos);
  CHECK(std::regex_search(shown, std::regex("\nfabric_anisotropy +-\n")));
  CHECK_THAT(here.run("inspect S.h5 --json").output, Contains("\"fabric_anisotropy\": null"));
}

TEST_CASE("a listing has one number in the same few digits everywhere, JSON all of them") {
  const Workplace here;
  here.import_packing("dense_p20");
  const std::string words = " biaxial --specimen S.h5 --set stage.compression.to_strain=0.02";
  const auto json = here.json("run" + words);
  char angle[16];
  std::snprintf(angle, sizeof angle, "%.1f", json.at("peak_friction_angle_deg").get<double>());
  CHECK_THAT(here.run("run" + words).output, Contains("peak_friction_angle_deg  " + std::string(angle) + " degrees\n"));
  const std::string calibrated = here.run("calibrate" + words + " --pressures 20e3,200e3").output;
  CHECK_THAT(calibrated, Contains("  " + std::string(angle) + "  "));  // in the table of tests
  CHECK(!std::regex_search(calibrated, std::regex("[0-9]\\.[0-9]{2,} degrees")));
  const std::string inspected = here.run("inspect S.h5").output;
  CHECK_THAT(inspected, Contains("p_Pa"));
  CHECK(!std::regex_search(inspected, std::regex("[0-9]e[+-]0[0-9]")));
}

TEST_CASE("a run that keeps no records says so, one that keeps or prints them does not") {
  const Workplace here;
  here.import_packing("dense_p20");
  const std::string test = "run biaxial --specimen S.h5 --set stage.compression.to_strain=0.001";
  const std::string lost = here.succeeds(test);
  CHECK_THAT(lost, Contains("none: the records are not kept without -o"));
  CHECK_THAT(here.run(test + " -o R.h5").output, !Contains("not kept"));
  CHECK_THAT(here.run(test + " --json").output, !Contains("not kept"));
  CHECK_THAT(here.run("run probe --specimen S.h5 --set stage.probe.method=linear").output, !Contains("not kept"));
}
