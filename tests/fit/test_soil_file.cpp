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
  CHECK(file.measured[0].assignments() ==
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
