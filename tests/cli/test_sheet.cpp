// rvelab sheet as a user runs it: a plan to its files; stopped, killed and resumed; shared; mistakes.
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "tests/child.hpp"
#include "tests/program.hpp"

using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

/// Few discs, short tests.
const std::string plan =
    "[sheet]\nseeds = 2\nsettings = [\"pack.number=60\", \"target.void_ratio_tolerance=0.02\"]\n"
    "[[density]]\nname = \"loose\"\nvoid_ratio = 0.23\n[[density]]\nname = \"dense\"\nvoid_ratio = 0.2\n"
    "[[test]]\nname = \"drained\"\npurpose = \"drained\"\nprotocol = \"triaxial\"\nprotocol_2D = \"biaxial\"\n"
    "pressures_Pa = [100e3, 200e3]\nsettings = [\"stage.compression.to_strain=0.05\"]\n"
    "[[test]]\nname = \"G\"\npurpose = \"cyclic_strain\"\nprotocol = \"cyclic_shear\"\namplitudes = [1e-3]\n"
    "records_per_amplitude = 10\nsettings = [\"stage.cycles.cycles=1\"]\nseeds = 1\n";
const std::string command = "sheet pack_dense --plan plan.toml -o ";
const char* const files[] = {"summary.json", "summary.csv", "index.html"};

/// Both sheets have the same bytes, and tests of the same bits.
void expect_same(const Workplace& here, const std::string& a, const std::string& b) {
  for (const char* file : files) CHECK(bytes_of(here / (a + "/" + file)) == bytes_of(here / (b + "/" + file)));
  std::size_t records = 0;
  for (const auto& entry : std::filesystem::directory_iterator(here / (a + "/tests"))) {
    const std::string name = "/tests/" + entry.path().filename().string();
    CAPTURE(name);
    REQUIRE(name.ends_with(".h5"));
    CHECK_FALSE(rvelab::io::compare_files(here / (a + name), here / (b + name)).difference);
    ++records;
  }
  CHECK(records == 10);
}

}  // namespace

TEST_CASE("A sheet goes from recipe to files, to the same bytes on two threads, after kills, and on two ranks") {
  const Workplace here;
  here.write("plan.toml", plan);
  const Outcome alone = here.run(command + "A --threads 1");
  INFO(alone.errors);
  REQUIRE(alone.code == 0);
  CHECK_THAT(alone.errors,
             Contains("2 densities, 4 specimens, 10 tests") && Contains("biaxial in the place of triaxial"));
  CHECK_THAT(alone.output, Contains("A/index.html, summary.json"));
  CHECK_THAT(bytes_of(here / "A/summary.json"), Contains("drained_dense_200kPa_s2"));
  here.succeeds("inspect A/tests/drained_dense_200kPa_s2.h5");
  here.succeeds("report A/tests -o report.html");

  here.succeeds(command + "B --threads 2");
  expect_same(here, "A", "B");

  int kills = 0;
  for (const double seconds : {0.05, 0.1, 0.3, 0.3}) {
    Child child({RVELAB_PROGRAM, "sheet", "pack_dense", "--plan", here / "plan.toml", "-o", here / "C", "--resume",
                 "--threads", "2"},
                here / "out", here / "err");
    if (!child.works_for(seconds)) break;
    child.signal(SIGKILL);
    if (child.wait() == 128 + SIGKILL) ++kills;
  }
  CHECK(kills >= 2);
  const std::string again = "sheet pack_dense --plan " + (here / "plan.toml") + " -o C --resume";
  here.succeeds(again);
  expect_same(here, "A", "C");
  const auto written = std::filesystem::last_write_time(here / "C/tests/drained_loose_100kPa_s1.h5");
  here.succeeds(again);
  CHECK(std::filesystem::last_write_time(here / "C/tests/drained_loose_100kPa_s1.h5") == written);

  const auto rank = [&](const std::string& number) {
    return "OMPI_COMM_WORLD_RANK=" + number + " OMPI_COMM_WORLD_SIZE=2 '" RVELAB_PROGRAM "' " + command +
           "D --share --threads 1 >rank" + number + ".out 2>rank" + number + ".err";
  };
  const Outcome ranks = here.shell(rank("1") + " & " + rank("0") + " && wait");
  INFO(bytes_of(here / "rank0.err") << bytes_of(here / "rank1.err"));
  REQUIRE(ranks.code == 0);
  CHECK(bytes_of(here / "rank1.out").empty());
  CHECK(bytes_of(here / "rank1.err").empty());
  expect_same(here, "A", "D");
}

TEST_CASE("Ctrl-C stops a sheet, and says how to go on") {
  const Workplace here;
  here.write("plan.toml", plan);
  for (const bool packs : {true, false}) {  // while specimens are packed, and while tests run
    const std::string folder = here / (packs ? "P" : "T");
    Child child({RVELAB_PROGRAM, "sheet", "pack_dense", "--plan", here / "plan.toml", "-o", folder, "--threads", "1",
                 "--set", packs ? "pack.number=3000" : "pack.number=200", "--set",
                 "test.drained.settings=[\"stage.compression.to_strain=0.3\"]"},
                here / "out", here / "err");
    const std::string awaited = folder + (packs ? "/specimens" : "/tests/drained_loose_100kPa_s1.h5.journal");
    for (int k = 0; k < 30'000 && !std::filesystem::exists(awaited); ++k) usleep(2000);
    REQUIRE(child.works_for(0.1));
    child.signal(SIGINT);
    CHECK(child.wait() == 128 + SIGINT);
    CHECK_THAT(bytes_of(here / "err"), Contains("stopped by Ctrl-C") && Contains("continue with --resume") &&
                                           Contains(packs ? "of 4 specimens packed" : "of 10 tests complete"));
  }
}

TEST_CASE("Given specimens are of one density where their names differ by a number; what they do not tell is said") {
  const Workplace here;
  here.write("plan.toml", plan);
  const std::string pack = " --set pack.number=60 --set target.void_ratio_tolerance=0.02 ";
  here.succeeds("pack pack_dense -o dense.h5 --count 2" + pack);
  here.succeeds("pack pack_loose -o wet.h5" + pack);
  const Outcome outcome = here.run("sheet 'dense_*.h5' wet.h5 --plan plan.toml -o A");
  INFO(outcome.errors);
  REQUIRE(outcome.code == 0);
  CHECK_THAT(outcome.errors, Contains("2 densities, 3 specimens, 8 tests") &&
                                 Contains("wet has one specimen: its numbers have no standard error") &&
                                 Contains("relative density of wet is not known"));
  CHECK_THAT(bytes_of(here / "A/summary.json"), Contains("wet has one specimen"));
  CHECK(std::filesystem::exists(here / "A/tests/drained_dense_200kPa_s2.h5"));

  here.write("measured.toml",
             "[[number]]\nkey = \"phi_peak_deg\"\ndensity = \"dense\"\npressure_Pa = 100e3\nvalue = 20\n"
             "by = \"A laboratory\"\n");
  here.succeeds("sheet 'dense_*.h5' wet.h5 --plan plan.toml -o A --resume --beside measured.toml");
  CHECK_THAT(bytes_of(here / "A/summary.json"), Contains("A laboratory"));
  here.write("wrong.toml", "[[numbr]]\nkey = \"phi_cs_deg\"\nvalue = 20\n");
  here.refuses("sheet 'dense_*.h5' wet.h5 --plan plan.toml -o B --beside wrong.toml", "wrong.toml", "numbr");
  here.refuses("sheet dense_1.h5 dense_1.h5 --plan plan.toml -o B", "same specimen");
  here.refuses("sheet dense_1.h5 --plan plan.toml -o B --set pack.number=3", "is given with specimens");
  CHECK_FALSE(std::filesystem::exists(here / "B"));
}

TEST_CASE("A folder of another sheet, a plan or a recipe with a mistake are refused in one line") {
  const Workplace here;
  here.write("plan.toml", plan);
  const auto loose = plan.find("[[density]]"), dense = plan.find("[[density]]", loose + 1);
  here.write("one.toml", plan.substr(0, loose) + plan.substr(dense));
  const std::string one = "sheet pack_dense --plan one.toml -o A --set sheet.seeds=1";
  const Outcome outcome = here.run(one);
  INFO(outcome.errors);
  REQUIRE(outcome.code == 0);
  CHECK_THAT(outcome.errors, Contains("there is one density") && Contains("dense has one specimen"));
  here.refuses(one, "--resume", "--force");
  here.refuses(one + " --resume --set pack.seed=4", "is of another sheet, whose specimens differ");
  here.refuses(one + " --resume --set 'test.drained.pressures_Pa=[100e3]'", "whose plan differ");
  here.succeeds(one + " --force --set 'test.drained.pressures_Pa=[100e3]'");
  CHECK_FALSE(std::filesystem::exists(here / "A/tests/drained_dense_200kPa_s1.h5"));
  here.write("A/models/norsand.txt", "of an old sheet");
  CHECK(here.run(one + " --force --set density.dense.void_ratio=0.6").code == 1);  // cannot be packed
  for (const char* file : {"A/index.html", "A/summary.json", "A/summary.csv", "A/models/norsand.txt"})
    CHECK_FALSE(std::filesystem::exists(here / file));

  here.refuses(command + "B --set 'test.drained.purpose=\"dried\"'", "test.drained.purpose", "drained");
  here.refuses(command + "B --set 'test.drained.protocol_2D=\"biaxail\"'", "test.drained", "nearest is biaxial");
  here.refuses(command + "B --set test.dranied.seeds=1", "dranied");
  here.refuses("sheet pack_dense --plan standrad -o B", "nearest is standard", "quick");
  here.refuses("sheet pack_dense --plan plan.toml -o B --set density.loose.void_ratio=x", "density.loose.void_ratio");
  here.refuses(command + "B --set target.void_ratio=0.21", "--set target.void_ratio=0.21 contradicts",
               "--set density.loose.void_ratio=VALUE");
  here.refuses("sheet pack_densee --plan plan.toml -o B", "nearest is pack_dense");
  here.refuses("sheet pack_dense pack_loose --plan plan.toml -o B", "pack_dense is given beside others");
  here.refuses(command + "B --set stage.compression.to_strain=0.1", "is a key of a protocol", "test.drained.settings");
  here.refuses(command + "B --set 'test.drained.settings=[\"stage.cmpression.to_strain=0.1\"]'",
               "test.drained: ", "names no stage");
  here.refuses(command + "B --set 'test.drained.pressures_Pa=[100e3, 100.00001e3]'", "two tests are called");
  here.refuses("sheet none.h5 --plan plan.toml -o B", "none.h5");
  here.refuses("sheet pack_dense --quick -o B", "density.loose", "target.relative_density", "target.e_min");
  here.refuses("sheet pack_dense --plan plan.toml -o plan.toml", "plan.toml");
  CHECK_FALSE(std::filesystem::exists(here / "B"));
}

TEST_CASE("A file of a clump that changed is noticed by --resume") {
  const Workplace here;
  here.write("plan.toml",
             "[sheet]\nseeds = 1\nsettings = [\"pack.number=60\", \"grains.pairs.clump=pair.csv\"]\n"
             "[[density]]\nname = \"dense\"\nsettings = [\"pack.seed=2\"]\n"
             "[[test]]\nname = \"drained\"\npurpose = \"drained\"\nprotocol = \"triaxial\"\n"
             "settings = [\"stage.compression.to_strain=0.01\"]\n");
  const auto shape = [&](const char* y) { here.write("pair.csv", std::string("x,y,z,r\n0,0,0,1\n1,") + y + ",0,1\n"); };
  const std::string command = "sheet pack_clumps --plan plan.toml -o A";
  shape("0");
  const Outcome outcome = here.run(command);
  INFO(outcome.errors);
  REQUIRE(outcome.code == 0);
  here.succeeds(command + " --resume");
  shape("0.5");
  here.refuses(command + " --resume", "is of another sheet, whose files (pair.csv) differ");
  here.succeeds(command + " --force");
}

TEST_CASE("A density out of reach, and a disk that fills, are told; the sheet is of the other tests") {
  const Workplace here;
  here.write("plan.toml", plan);
  const Outcome loose = here.run(command + "A --set sheet.seeds=1 --set density.loose.void_ratio=0.6");
  CHECK(loose.code == 1);
  CHECK_THAT(loose.errors,
             Contains("S_loose_1 could not be packed") && Contains("3 of 6 tests could not be carried out"));
  CHECK_THAT(bytes_of(here / "A/summary.json"), Contains("S_loose_1 could not be packed"));
  const Outcome full = here.shell("ulimit -f 40; '" RVELAB_PROGRAM "' " + command + "B");
  CHECK(full.code == 1);
  CHECK_THAT(full.errors, Contains("B/specimens/S_") && Contains("could not be written"));
}
