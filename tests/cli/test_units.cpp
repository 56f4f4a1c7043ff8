// Units that no soil has, cohesion and long words, as a user meets them.
#include <cmath>

#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/io/journal/recorded_test.hpp"
#include "tests/program.hpp"

using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

const char* const discs = R"([pack]
name = "discs"
number = 60
[grains]
smallest_radius_m = 3e-3
largest_radius_m = 7e-3
[target]
pressure_Pa = 100e3
[[material]]
name = "sand"
young_modulus_Pa = 8e8
stiffness_ratio = 0.5
friction = 0.4
)";

std::size_t lines_with(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

}  // namespace

TEST_CASE("pack warns of a key once, whatever the number of specimens, and the specimens hold the warning") {
  const Workplace here;
  here.write("r.toml", discs);
  const Outcome outcome = here.run("pack r.toml -o S.h5 --count 2 --set material.friction=27");
  INFO(outcome.errors);
  CHECK(outcome.code == 0);
  CHECK(lines_with(outcome.errors, "is unusual") == 1);
  CHECK_THAT(outcome.errors,
             Contains("warning: ") && Contains("material.friction = 27") && Contains("angle in degrees"));
  const auto origin = rvelab::io::read_origin(here / "S_2.h5");
  REQUIRE(origin);
  CHECK_THAT(origin->recipe, Contains("# --set material.friction=27: material.friction = 27 is unusual"));
  CHECK(here.run("pack r.toml -o T.h5").errors.find("unusual") == std::string::npos);
  here.refuses("pack r.toml -o U.h5 --set material.young_modulus_Pa=70", "young_modulus_Pa = 70");
  CHECK(!std::filesystem::exists(here / "U.h5"));
}

TEST_CASE("run warns of a pressure in kPa, its records hold the warning, and it refuses what cannot exist") {
  const Workplace here;
  here.import_packing("dense_p20");
  const std::string brief = "run biaxial --specimen S.h5 --set stage.compression.to_strain=0.001 ";
  const Outcome outcome = here.run(brief + "-o R.h5 --set test.pressure_Pa=200");
  INFO(outcome.errors);
  CHECK(lines_with(outcome.errors, "is unusual") == 1);
  CHECK_THAT(outcome.errors, Contains("test.pressure_Pa = 200") && Contains("kPa"));
  CHECK_THAT(rvelab::io::read_recorded_test(here / "R.h5").provenance.protocol,
             Contains("# --set test.pressure_Pa=200: test.pressure_Pa = 200 is unusual"));
  CHECK(here.run(brief + "-o R.h5 --set test.pressure_Pa=200 --resume").code == 0);  // still the same test
  here.refuses(brief + "-o Q.h5 --set material.young_modulus_Pa=70", "young_modulus_Pa = 70");
  CHECK(here.run(brief + "-o P.h5").errors.find("unusual") == std::string::npos);
}

TEST_CASE("calibrate of grains that stick tells the cohesion and prints N_c of the line") {
  const Workplace here;
  here.import_packing("dense_p20");
  const std::string brief =
      "calibrate biaxial --specimen S.h5 --pressures 10e3,20e3,40e3 --set stage.compression.to_strain=0.02 "
      "--set contact.law=linear_adhesive ";
  const auto found = here.json(brief + "--set material.adhesion_Pa=5e4");
  CHECK(found["cohesive"] == true);
  CHECK(found["friction_angle_deg"] == found["friction_angle_with_cohesion_deg"]);
  CHECK(found["friction_angle_deg"].get<double>() < found["secant_friction_angle_deg"].get<double>());
  CHECK_THAT(found["cohesion"].get<std::string>(), Contains("the grains stick") && Contains("tangent angle"));
  const double phi = found["friction_angle_deg"].get<double>() * 3.14159265358979323846 / 180;
  CHECK(found["bearing_capacity_Nc"].get<double>() ==
        Approx((found["bearing_capacity_Nq"].get<double>() - 1) / std::tan(phi)));
  // Without adhesion the same law gives what it gave: the secant.
  const auto plain = nlohmann::json::parse(here.run(brief + "--json").output);
  CHECK(plain["friction_angle_deg"] == plain["secant_friction_angle_deg"]);
  CHECK(plain["cohesive"] == false);
}

TEST_CASE("a word of thousands of letters is echoed in at most 80, whatever it stands for") {
  const Workplace here;
  here.import_packing("dense_p20");
  const std::string word(9000, 'q');
  here.write("long_name.toml", "[test]\nname = \"" + word + "\"\n[[stage]]\nkind = \"" + word + "\"\n");
  here.write("long_key.toml", "[test]\n" + word + " = 1\n[" + word + "]\n");
  here.write("long_value.toml", "[pack]\nname = 1\nshape = \"" + word + "\"\n");
  for (const std::string& arguments : std::vector<std::string>{
           word, "run " + word, "pack " + word + " -o T.h5", "run biaxial --" + word, "keys " + word,
           "run biaxial --specimen " + word, "run biaxial --specimen S.h5 --set " + word + "=1",
           "run biaxial --specimen S.h5 --set test.pressure_Pa=" + word, "run long_name.toml --specimen S.h5",
           "run long_key.toml --specimen S.h5", "pack long_value.toml -o T.h5", "inspect " + word + ".h5",
           "calibrate biaxial --specimen S.h5 --pressures " + word, "report " + word + " -o r.html"}) {
    CAPTURE(arguments.substr(0, 40));
    const Outcome outcome = here.run(arguments);
    CHECK((outcome.code == 1 || outcome.code == 2));
    CHECK(outcome.errors.find(std::string(81, 'q')) == std::string::npos);
    CHECK(outcome.errors.find("qqq") != std::string::npos);
  }
}
