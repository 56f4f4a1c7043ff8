// Ensembles as a user runs them: several specimens by one command, stopped and resumed, two groups compared.
#include "tests/program.hpp"

using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

Workplace& with_packings(Workplace& here) {
  here.import_packing("dense_p20", "S_a.h5");
  here.import_packing("medium_p20", "S_b.h5");
  here.import_packing("soft_p20", "S_c.h5");
  return here;
}

}  // namespace

TEST_CASE("An ensemble gives for each specimen what a run of it alone gives, and their mean and standard error") {
  Workplace place;
  const Workplace& here = with_packings(place);
  const std::string outcome = here.succeeds(std::string("run biaxial --specimen S_a.h5 S_b.h5 S_c.h5 -o D") + brief);
  CHECK_THAT(outcome, Contains("friction_angle_deg") && Contains("+-") && Contains("bearing_capacity_Nq"));
  const auto summary = nlohmann::json::parse(bytes_of(here / "D/summary.json"));
  REQUIRE(summary["tests"].size() == 3);
  double sum = 0, squares = 0;
  for (const std::string name : {"a", "b", "c"}) {
    const auto alone =
        nlohmann::json::parse(here.run("run biaxial --specimen S_" + name + ".h5 --json" + brief).output);
    const auto& one = summary["tests"][std::size_t(name[0] - 'a')];
    CHECK(one["friction_angle_deg"].get<double>() == alone["peak_friction_angle_deg"].get<double>());
    CHECK(std::filesystem::exists(here / ("D/R_" + name + ".h5")));
    sum += one["friction_angle_deg"].get<double>() / 3;
  }
  for (const auto& one : summary["tests"]) squares += std::pow(one["friction_angle_deg"].get<double>() - sum, 2);
  const auto row = *std::find_if(summary["summary"].begin(), summary["summary"].end(),
                                 [](const auto& each) { return each["measure"] == "friction_angle_deg"; });
  CHECK(row["n"] == 3);
  CHECK(row["mean"].get<double>() == Approx(sum));
  CHECK(row["standard_error"].get<double>() == Approx(std::sqrt(squares / 2 / 3)));
  CHECK_THAT(bytes_of(here / "D/summary.csv"),
             Contains("group,pressure_Pa,measure,unit,n,mean,standard_deviation,standard_error,low_95,high_95\n") &&
                 Contains(",20000,friction_angle_deg,degrees,3,"));
}

TEST_CASE("An ensemble that was stopped and resumed has the same summary, whatever the number of threads") {
  Workplace place;
  const Workplace& here = with_packings(place);
  const std::string test = std::string("run biaxial --specimen 'S_*.h5' -o ");
  here.succeeds(test + "whole --threads 1" + brief);
  // Killed on its way: a file is missing, another has a journal only.
  here.run(test + "cut --threads 2 --checkpoint-every 0.01" + brief + " & sleep 0.4; kill -9 $!");
  here.refuses(test + "whole" + brief, "--resume");
  here.succeeds(test + "cut --threads 2 --resume" + brief);
  CHECK(bytes_of(here / "cut/summary.json") == bytes_of(here / "whole/summary.json"));
  CHECK(bytes_of(here / "cut/summary.csv") == bytes_of(here / "whole/summary.csv"));
}

TEST_CASE("Two groups are compared by the difference of their means") {
  Workplace place;
  const Workplace& here = with_packings(place);
  const auto found = nlohmann::json::parse(
      here.run(std::string("run biaxial --specimen S_a.h5 S_b.h5 --against S_c.h5 --json") + brief).output);
  CHECK(found["groups"] == nlohmann::json({"group 1", "group 2"}));
  bool compared = false;
  for (const auto& each : found["differences"]) {
    if (each["measure"] != "friction_angle_deg") continue;
    compared = true;
    const auto angle = [&](std::size_t k) { return found["tests"][k]["friction_angle_deg"].get<double>(); };
    CHECK(each["difference"].get<double>() == Approx((angle(0) + angle(1)) / 2 - angle(2)));
  }
  CHECK(compared);
}

TEST_CASE("An ensemble refuses a specimen given twice, a pattern that fits nothing, and tells of a test that fails") {
  Workplace place;
  const Workplace& here = with_packings(place);
  std::filesystem::copy_file(here / "S_a.h5", here / "T.h5");
  here.refuses("run biaxial --specimen S_a.h5 T.h5", "T.h5 holds the same specimen as S_a.h5");
  here.refuses("run biaxial --specimen 'X_*.h5'", "X_*.h5: no file has such a name");
  const Outcome failed = here.run(std::string("run biaxial --specimen 'S_*.h5' --set solver.max_substeps=3") + brief);
  CHECK(failed.code == 1);
  CHECK_THAT(failed.errors, Contains("S_b.h5: ") && Contains("3 of 3 tests could not be carried out"));
}

TEST_CASE("A calibration keeps the summary of its specimens beside its records") {
  Workplace place;
  const Workplace& here = with_packings(place);
  const std::string outcome = here.succeeds(
      "calibrate biaxial --specimen S_a.h5 S_b.h5 S_c.h5 --every-pressure --pressures 15e3,20e3 -o D "
      "--set stage.compression.to_strain=0.01");
  std::size_t longest = 0;
  std::istringstream lines(outcome);
  for (std::string line; std::getline(lines, line);)
    if (!line.starts_with("warning ")) longest = std::max(longest, line.size());
  CHECK(longest <= 130);
  const auto summary = nlohmann::json::parse(bytes_of(here / "D/summary.json"));
  CHECK(summary["tests"].size() == 6);
  const auto has = [&](const std::string& measure) {
    return std::any_of(summary["summary"].begin(), summary["summary"].end(), [&](const auto& row) {
      return row["measure"] == measure && row["n"] == 3 && row["low_95"] <= row["mean"] &&
             row["mean"] <= row["high_95"];
    });
  };
  for (const char* measure : {"cohesion_Pa", "bearing_capacity_Nq", "bearing_capacity_Nc", "bearing_capacity_Ngamma",
                              "local_shear_Nq", "wedge_angle_deg", "spiral_ratio", "E50_Pa", "poisson_ratio"})
    CHECK(has(measure));
}
