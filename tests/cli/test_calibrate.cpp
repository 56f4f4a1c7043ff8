// rvelab calibrate as a soil laboratory reads it: scatter of specimens, what is missing and why, peaks that are none.
#include <cmath>
#include <map>
#include <regex>

#include "tests/program.hpp"

using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

nlohmann::json calibrated(const Workplace& here, const std::string& arguments) {
  return here.json("calibrate biaxial " + arguments);
}

}  // namespace

TEST_CASE("several specimens give mean, standard deviation and standard error of angle and N_q") {
  const Workplace here;
  here.import_packing("dense_p20", "A.h5");
  here.import_packing("medium_p20", "B.h5");
  here.import_packing("soft_p20", "C.h5");
  const std::string three = "--specimen A.h5 --specimen B.h5 --specimen C.h5 --set stage.compression.to_strain=0.01 ";
  const auto found = calibrated(here, three + "--pressures 20e3 -o new/folder");
  REQUIRE(found["per_specimen"].size() == 3);
  for (const std::string name : {"friction_angle", "bearing_capacity_Nq"}) {
    const std::string unit = name == "friction_angle" ? "_deg" : "";
    double sum = 0, squares = 0;
    for (const auto& one : found["per_specimen"]) sum += one[name + unit].get<double>() / 3;
    for (const auto& one : found["per_specimen"]) squares += std::pow(one[name + unit].get<double>() - sum, 2);
    CHECK(found[name + "_mean" + unit].get<double>() == Approx(sum));
    CHECK(found[name + "_standard_deviation" + unit].get<double>() == Approx(std::sqrt(squares / 2)));
    CHECK(found[name + "_standard_error" + unit].get<double>() == Approx(std::sqrt(squares / 2 / 3)));
    CHECK(squares > 0);
  }
  // One specimen alone has the angle that it has among the others.
  const auto alone = calibrated(here, "--specimen B.h5 --set stage.compression.to_strain=0.01 --pressures 20e3");
  CHECK(alone["friction_angle_deg"] == found["per_specimen"][1]["friction_angle_deg"]);
  CHECK(alone["specimens"] == 1);
  CHECK(!alone.contains("friction_angle_standard_deviation_deg"));
  for (const char* file : {"R_20000_1.h5", "R_20000_2.h5", "R_20000_3.h5"}) {
    CHECK(std::filesystem::exists(here / ("new/folder/" + std::string(file))));
  }
  // Every one at every pressure where that is asked for; else a number that does not fit is refused with the remedy.
  const auto all = calibrated(here, three + "--pressures 15e3,20e3 --every-pressure");
  CHECK(all["per_pressure"].size() == 6);
  CHECK(all["per_specimen"].size() == 3);
  here.refuses("calibrate biaxial " + three + "--pressures 15e3,20e3", "--every-pressure");
  CHECK_THAT(here.run("calibrate biaxial " + three + "--pressures 20e3").output,
             Contains("friction_angle_mean_deg") && Contains("friction_angle_standard_error_deg"));
}

TEST_CASE("a figure that cannot be had is no number, and the reason stands beside it") {
  const Workplace here;
  here.import_packing("dense_p20");
  const std::string brief =
      "calibrate biaxial --specimen S.h5 --pressures 20e3 --set stage.compression.to_strain=0.003";
  const std::string shown = here.succeeds(brief);
  CHECK(shown.find("nan") == std::string::npos);
  const auto json = here.json(brief);
  CHECK(json["cohesion_Pa"].is_null());
  const std::map<std::string, std::string> lacks{{"friction_angle_moving_mean_deg", "records over 1 % of strain"},
                                                 {"cohesion_Pa", "two pressures"},
                                                 {"large_strain_friction_angle_deg", "12 to 15 % of strain"}};
  for (const auto& [name, reason] : lacks) {
    const std::string said = json["undefined"][name];
    CHECK_THAT(said, Contains(reason));
    CHECK_THAT(shown, Contains(said));
    CHECK(std::regex_search(shown, std::regex("\\n" + name + " +- ")));
  }
  CHECK(json["undefined"].size() == 6);
}

TEST_CASE("a test that is still rising at its end has no peak, and a calibration says so") {
  const Workplace here;
  here.import_packing("dense_p20");
  const auto brief = calibrated(here, "--specimen S.h5 --pressures 15e3,20e3 --set stage.compression.to_strain=0.003");
  CHECK_THAT(brief["warning"].get<std::string>(), Contains("15000 Pa") && Contains("20000 Pa") &&
                                                      Contains("still rising at the end: no peak") &&
                                                      Contains("0.3 % strain") && Contains("to_strain"));
  CHECK(brief["per_pressure"][0]["rising_at_end"] == true);
  const auto whole = calibrated(here, "--specimen S.h5 --pressures 20e3 --set stage.compression.to_strain=0.03");
  CHECK(!whole.contains("warning"));
  CHECK(whole["per_pressure"][0]["rising_at_end"] == false);
}

TEST_CASE("a specimen or a pressure that is given twice, and an empty list, are refused by calibrate") {
  const Workplace here;
  here.import_packing("dense_p20");
  std::filesystem::copy_file(here / "S.h5", here / "T.h5");
  for (const std::string choice : {"--every-pressure", "--pressures 20e3"}) {
    here.refuses("calibrate biaxial --specimen S.h5 --specimen T.h5 " + choice, "T.h5", "the same", "S.h5");
  }
  here.refuses("calibrate biaxial --specimen S.h5 --pressures 10e3,20e3,10e3", "--pressures holds 10000 Pa twice");
  here.refuses("calibrate biaxial --specimen S.h5 --pressures ''", "--pressures holds \"\"");
}

TEST_CASE("the folder of a calibration is made, and told where it cannot be") {
  const Workplace here;
  here.import_packing("dense_p20");
  const std::string brief =
      "calibrate biaxial --specimen S.h5 --pressures 20e3 --set stage.compression.to_strain=0.001";
  CHECK(here.run(brief + " -o a/b/c").code == 0);
  CHECK(std::filesystem::exists(here / "a/b/c/R_20000.h5"));
  here.refuses(brief + " -o S.h5", "S.h5: the folder cannot be made");
  here.refuses(brief + " -o S.h5/deep", "S.h5/deep: the folder cannot be made");
  // A mistake leaves no folder behind.
  here.refuses(brief + " -o none --set material.steel.friction=0.1", "steel");
  CHECK(!std::filesystem::exists(here / "none"));
}

TEST_CASE("the help explains what calibrate and run print") {
  const Workplace here;
  CHECK_THAT(here.run("calibrate --help").output,
             Contains("wedge_angle_deg:") && Contains("local_shear_Nq:") && Contains("standard error"));
  CHECK_THAT(here.run("run --help").output, Contains("q: deviatoric stress") && Contains("eps_q:"));
}
