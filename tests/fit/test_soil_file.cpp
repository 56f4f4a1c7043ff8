// What the file of a fit of several tests says, and its mistakes.
#include "rvelab/fit/soil_file.hpp"
#include "rvelab/keys/toml_source.hpp"
#include "tests/catch.hpp"
#include "tests/refusal.hpp"

using namespace rvelab;
using Catch::Matchers::Contains;
using rvelab::test::input_error;

namespace {

fit::SoilFile read(const std::string& text) { return fit::read_soil_file(keys::parse_toml(text), "soil.toml"); }

const std::string fit_table = "[fit]\nrecipe = \"sand\"\nvary = [\"material.friction=0.1:1\"]\n";
const std::string one_test = "[[measured]]\nname = \"A\"\nprotocol = \"triaxial\"\ncurve = \"a.csv\"\n";

}  // namespace

TEST_CASE("A soil file names recipe, ranges and tests, each with its specimen") {
  const fit::SoilFile file = read(fit_table + "count = 7\ntests = 40\nsettings = [\"pack.number=100\"]\n" + one_test +
                                  "columns = [\"axial_strain\", \"deviator_kPa=q\"]\nto = 15\npressure_Pa = 100e3\n"
                                  "relative_density = 0.25\nsettings = [\"stage.compression.to_strain=0.1\"]\n"
                                  "[[measured]]\nname = \"B\"\nprotocol = \"biaxial\"\npredict = true\n"
                                  "targets = [\"friction_angle_deg=33+-1\"]\n");
  CHECK(file.count == 7);
  CHECK(file.tests == 40);
  REQUIRE(file.parameters.size() == 1);
  CHECK(file.parameters[0].high == 1);
  REQUIRE(file.measured.size() == 2);
  CHECK(file.measured[0].selection.columns[1] == "deviator_kPa=q");
  CHECK(file.measured[0].selection.to == 15.0);
  CHECK(file.assignments(file.measured[0]) ==
        std::vector<std::string>{"target.pressure_Pa=100000", "test.pressure_Pa=100000", "target.relative_density=0.25",
                                 "stage.compression.to_strain=0.1"});
  CHECK(file.measured[1].predict);
  CHECK(file.measured[1].targets[0].error == 1);
}

TEST_CASE("Mistakes of a soil file are named with their lines") {
  const auto refused = [](const std::string& text) { return input_error([&] { read(text); }); };
  CHECK_THAT(refused("[fit]\n" + one_test), Contains("fit.recipe"));
  CHECK_THAT(refused(fit_table), Contains("[[measured]]"));
  CHECK_THAT(refused(fit_table + "recpe = 1\n" + one_test), Contains("soil.toml:4") && Contains("fit.recipe"));
  CHECK_THAT(refused(fit_table + one_test + one_test), Contains("stands twice"));
  CHECK_THAT(refused(fit_table + one_test + "predict = true\n"), Contains("only tests to predict"));
  CHECK_THAT(refused(fit_table + one_test + "void_ratio = 0.7\nrelative_density = 0.5\n"), Contains("contradicts"));
  CHECK_THAT(refused(fit_table + "[[measured]]\nname = \"A\"\nprotocol = \"triaxial\"\n"),
             Contains("neither curve nor targets"));
  CHECK_THAT(refused(fit_table + "[[measured]]\nname = \"A\"\nprotocol = \"triaxial\"\nfrom = 1\n"
                                 "targets = [\"friction_angle_deg=33\"]\n"),
             Contains("without a curve"));
  CHECK_THAT(refused("[fit]\nrecipe = \"sand\"\nvary = [\"material.friction=0.1:1:5\"]\n" + one_test),
             Contains("sweep"));
  CHECK_THAT(refused("[fit]\nrecipe = \"sand\"\nvary = [\"material.friction\"]\n" + one_test),
             Contains("is no key with a range"));
  CHECK_THAT(refused(fit_table + one_test + "targets = [\"friction_angle_deg@1e5=33\"]\n"), Contains("pressure_Pa"));
}

TEST_CASE("A soil file compares features where it says so, and repeats a test of the laboratory") {
  const std::string repeated = "[[measured]]\nname = \"B\"\nrepeats = \"A\"\ncurve = \"b.csv\"\n";
  const fit::SoilFile file = read(fit_table + "compare = \"features\"\n" + one_test + repeated);
  CHECK(file.compares_features(file.measured[0]));
  CHECK(file.measured[1].repeats == "A");
  const fit::SoilFile old = read(fit_table + one_test);
  CHECK(!old.compares_features(old.measured[0]));
  CHECK(read(fit_table + one_test + "features = [\"largest_q_Pa\"]\n").measured[0].features.size() == 1);
  const fit::SoilFile mixed = read(fit_table + "compare = \"features\"\n" + one_test + "compare = \"curves\"\n");
  CHECK(!mixed.compares_features(mixed.measured[0]));
  const auto refused = [](const std::string& text) { return input_error([&] { read(text); }); };
  CHECK_THAT(refused(fit_table + one_test + "compare = \"curves\"\nfeatures = [\"largest_q_Pa\"]\n"),
             Contains("one of the two"));
  CHECK_THAT(refused(fit_table + one_test + "features = [\"larges_q_Pa\"]\n"),
             Contains("nearest") && Contains("largest_q_Pa"));
  CHECK_THAT(refused(fit_table + one_test + repeated), Contains("points of A") && Contains("fit.compare"));
  CHECK_THAT(refused(fit_table + "compare = \"features\"\n" + repeated + one_test), Contains("no test with a curve"));
  CHECK_THAT(refused(fit_table + "compare = \"features\"\n" + one_test + repeated + "pressure_Pa = 1e5\n"),
             Contains("that is repeated"));
  CHECK_THAT(refused(fit_table + "compare = \"feature\"\n" + one_test), Contains("fit.compare"));
  CHECK_THAT(refused(fit_table + "[[measured]]\nname = \"A\"\ncurve = \"a.csv\"\n"), Contains("protocol"));
}

TEST_CASE("A void ratio of the sand becomes a relative density, which the limits of the recipe map") {
  const std::string sand = "e_min = 0.6\ne_max = 1.0\n";
  const fit::SoilFile file = read(fit_table + sand + one_test + "void_ratio = 0.7\n");
  CHECK(file.assignments(file.measured[0]) == std::vector<std::string>{"target.relative_density=0.75"});
  const fit::SoilFile own = read(fit_table + one_test + "void_ratio = 0.7\n");
  CHECK(own.assignments(own.measured[0]) == std::vector<std::string>{"target.void_ratio=0.7"});
  const auto refused = [](const std::string& text) { return input_error([&] { read(text); }); };
  CHECK_THAT(refused(fit_table + "e_min = 0.6\n" + one_test), Contains("e_max"));
  CHECK_THAT(refused(fit_table + "e_min = 1.1\ne_max = 1.0\n" + one_test), Contains("e_min below e_max"));
}
