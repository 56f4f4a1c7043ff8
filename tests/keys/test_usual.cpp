// Values that are allowed and in another unit: told with key, value and likely unit, and no mistakes.
#include <cmath>

#include "rvelab/error.hpp"
#include "rvelab/keys/material_toml.hpp"
#include "rvelab/keys/shortened.hpp"
#include "rvelab/keys/table_reader.hpp"
#include "tests/catch.hpp"

using namespace rvelab;
using Catch::Matchers::Contains;

namespace {

/// What is unusual in a material file.
std::vector<std::string> doubts_of(const std::string& material, const std::string& law = "linear") {
  const toml::table file =
      keys::parse_toml_text("[contact]\nlaw = \"" + law + "\"\n[[material]]\n" + material + "\n", "soil.toml");
  Specimen specimen;
  specimen.materials.resize(1);
  std::vector<keys::KeyError> errors;
  keys::read_material_tables(file, specimen, errors);
  CHECK(keys::mistakes_in(errors) == 0);
  keys::raise("soil.toml", errors);  // a doubt is no mistake
  return keys::doubts_in(errors);
}

}  // namespace

TEST_CASE("a friction that is an angle in degrees is told with its tangent, one that means no slip is not") {
  for (const double angle : {2.5, 15.0, 27.0, 89.0}) {
    const auto doubts = doubts_of("friction = " + keys::as_toml(angle));
    REQUIRE(doubts.size() == 1);
    char tangent[32];
    std::snprintf(tangent, sizeof tangent, "%.4g", std::tan(angle * 3.14159265358979323846 / 180));
    CHECK_THAT(doubts[0], Contains("material.friction = " + keys::as_toml(angle)) && Contains("angle in degrees") &&
                              Contains(tangent) && Contains("friction_angle_deg"));
  }
  CHECK_THAT(doubts_of("rolling_friction = 10").at(0), Contains("material.rolling_friction = 10") && Contains("angle"));
  for (const char* usual : {"friction = 0", "friction = 0.577", "friction = 1.9", "friction = 1e6", "friction = 100",
                            "rolling_friction = 0.5", "friction_angle_deg = 0", "friction_angle_deg = 35"})
    CHECK(doubts_of(usual).empty());
  CHECK_THAT(doubts_of("friction_angle_deg = 0.5").at(0), Contains("coefficient") && Contains("28.65 degrees"));
}

TEST_CASE("densities and moduli that no solid has are told in the unit in which they are usual") {
  CHECK_THAT(doubts_of("density_kg_m3 = 2.65").at(0),
             Contains("density_kg_m3 = 2.65") && Contains("g/cm^3: write 2650"));
  CHECK_THAT(doubts_of("density_kg_m3 = 2.65e-9").at(0), Contains("t/mm^3") && Contains("2650"));
  CHECK_THAT(doubts_of("density_kg_m3 = 2.65e6").at(0), Contains("g/m^3") && Contains("2650"));
  CHECK_THAT(doubts_of("young_modulus_Pa = 70").at(0),
             Contains("young_modulus_Pa = 70") && Contains("MPa") && Contains("GPa") && Contains("7e+10"));
  CHECK_THAT(doubts_of("young_modulus_Pa = 7e16").at(0), Contains("young_modulus_Pa = 7e+16"));
  // Glass, steel, ceramics, rubber, foam, tungsten.
  for (const char* usual : {"young_modulus_Pa = 70e9", "young_modulus_Pa = 210e9", "young_modulus_Pa = 400e9",
                            "young_modulus_Pa = 1e6", "density_kg_m3 = 30", "density_kg_m3 = 19300"})
    CHECK(doubts_of(usual).empty());
}

TEST_CASE("a Poisson's ratio in per cent is refused with the ratio, as are other shares") {
  Specimen specimen;
  specimen.contact.law = Law::hertz_mindlin;
  specimen.materials.resize(1);
  CHECK_THROWS_WITH(keys::set_key(specimen, "material.poisson_ratio=25"),
                    Contains("poisson_ratio = 25") && Contains("if per cent was meant, write 0.25"));
  CHECK_THROWS_WITH(keys::set_key(specimen, "material.stiffness_ratio=50"), Contains("per cent") && Contains("0.5"));
}

TEST_CASE("materials that were read elsewhere are looked at by what their law reads") {
  Material sand;
  sand.young_modulus = 70;
  sand.friction = 30;
  sand.normal_stiffness = 1e-9;  // of another law
  const auto found = keys::unusual_materials({}, {sand, sand});
  REQUIRE(found.size() == 2);  // once a key
  CHECK_THAT(found[0], Contains("young_modulus_Pa = 70"));
  CHECK_THAT(found[1], Contains("friction = 30"));
  CHECK(keys::key_of_doubt(found[1]) == "material.grain.friction");
  CHECK(keys::key_of_doubt("--set test.pressure_Pa=100: test.pressure_Pa = 100 is unusual") == "test.pressure_Pa");
}

TEST_CASE("doubts are comments of TOML, on one line each, whatever a name holds") {
  const std::string text = keys::with_doubts({"material.a\nb.friction = 27 is unusual"}, "x = 1\n");
  CHECK(toml::parse(text)["x"].value<int>() == 1);
  CHECK(text.starts_with("# material.a"));
}
