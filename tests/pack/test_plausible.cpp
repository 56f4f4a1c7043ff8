// Whether a recipe can exist: the overlap that is expected of it is that of packings; recipes of other units are told.
#include <filesystem>

#include "rvelab/error.hpp"
#include "rvelab/keys/key.hpp"
#include "rvelab/measure/proportions.hpp"
#include "rvelab/pack/consolidation.hpp"
#include "rvelab/pack/draw.hpp"
#include "rvelab/pack/plausible.hpp"
#include "rvelab/pack/read_recipe.hpp"
#include "tests/catch.hpp"
#include "tests/pack/recipes.hpp"

using namespace rvelab;
using Catch::Matchers::Contains;

namespace {

/// A recipe of discs, or of spheres, with other numbers.
pack::RecipeFile recipe_of(const std::string& settings_of_material, const std::string& pressure = "100e3",
                           const std::string& law = "linear", const std::string& head = "number = 100",
                           const std::string& radii = "smallest_radius_m = 3e-3\nlargest_radius_m = 7e-3") {
  return pack::parse_recipe("[pack]\nname = \"a\"\n" + head + "\n" +
                                (radii.starts_with("name") ? "[[grains]]\n" : "[grains]\n") + radii +
                                "\n[target]\npressure_Pa = " + pressure + "\n[contact]\nlaw = \"" + law +
                                "\"\n[[material]]\nname = \"sand\"\n" + settings_of_material + "\n",
                            "r.toml");
}

}  // namespace

TEST_CASE("the overlap expected of a pressure is that of packings within a factor of two") {
  for (const auto& recipe : {test::discs(), test::spheres()}) {
    const Specimen packed = pack::draw(recipe, 1, 0.2, nullptr).specimen;
    const double measured = proportions_of(Rve(packed).network()).mean_overlap;
    const double expected =
        pack::expected_overlap(pack::pressed(packed, "p", 1e5), packed.contact, packed.materials.front());
    CAPTURE(measured, expected, int(recipe.contact.law));
    CHECK(expected < 2 * measured);
    CHECK(expected > 0.5 * measured);
  }
}

TEST_CASE("a stiffness with which grains would overlap by their radius is refused by its key, with the likely unit") {
  for (const char* modulus : {"70", "0.8", "800", "70e3"})
    CHECK_THROWS_WITH(recipe_of("young_modulus_Pa = " + std::string(modulus)),
                      Contains("r.toml: ") && Contains("material.sand.young_modulus_Pa") && Contains("Pa") &&
                          Contains("target.pressure_Pa = 100000") && Contains("likely in"));
  CHECK_THROWS_WITH(recipe_of("normal_stiffness_N_m = 6\ntangential_stiffness_N_m = 2", "20e3", "linear_stiffness"),
                    Contains("normal_stiffness_N_m = 6") && Contains("MN/m"));
  CHECK_THROWS_WITH(recipe_of("normal_stiffness_N_m1_5 = 20\ntangential_stiffness_N_m = 2", "100e3", "hertz_stiffness",
                              "shape = \"sphere\"\nnumber = 100"),
                    Contains("normal_stiffness_N_m1_5 = 20"));
  CHECK_THROWS_WITH(recipe_of("young_modulus_Pa = 70\npoisson_ratio = 0.2", "100e3", "hertz_mindlin",
                              "shape = \"sphere\"\nnumber = 100"),
                    Contains("young_modulus_Pa = 70") && Contains("MPa or GPa"));
  // The force on a grain of a slab grows with its thickness.
  CHECK_THROWS_WITH(recipe_of("young_modulus_Pa = 800e6", "100e3", "linear", "thickness_m = 100"),
                    Contains("diameters thick"));
  CHECK_NOTHROW(recipe_of("young_modulus_Pa = 800e6", "100e3", "linear", "thickness_m = 1"));
}

TEST_CASE("a recipe in other units is told by the key, and its text holds what was told") {
  const std::string usual = "young_modulus_Pa = 800e6\nfriction = 0.4";
  CHECK(recipe_of(usual).doubts.empty());
  CHECK(recipe_of(usual, "1e3").doubts.empty());  // 6 cm of soil
  const auto low = recipe_of(usual, "100");
  REQUIRE(low.doubts.size() == 1);
  CHECK_THAT(low.doubts[0], Contains("target.pressure_Pa = 100") && Contains("kPa") && Contains("write 1e+05"));
  CHECK_THAT(low.resolved, Contains("# target.pressure_Pa = 100 is unusual"));
  CHECK_THAT(low.member(7).resolved, Contains("# target.pressure_Pa = 100 is unusual"));
  CHECK(pack::parse_recipe(low.resolved, "again.toml").resolved == low.resolved);

  CHECK_THAT(recipe_of("young_modulus_Pa = 800e6\nfriction = 27").doubts.at(0), Contains("friction = 27"));
  const auto millimetres =
      recipe_of(usual, "100e3", "linear", "number = 100", "smallest_radius_m = 3\nlargest_radius_m = 7");
  REQUIRE(millimetres.doubts.size() == 2);
  CHECK_THAT(millimetres.doubts[0], Contains("smallest_radius_m = 3") && Contains("mm") && Contains("write 0.003"));
  // Grains that are soft, but no softer than rubber under some pressure.
  const auto soft = recipe_of("young_modulus_Pa = 8e6");
  REQUIRE(soft.doubts.size() == 1);
  CHECK_THAT(soft.doubts[0], Contains("young_modulus_Pa = 8000000") && Contains("target.pressure_Pa = 100000") &&
                                 Contains("overlap by some"));
  // An assignment is named.
  const auto assigned = pack::parse_recipe(recipe_of(usual).resolved, "r.toml", {"material.friction=30"});
  CHECK_THAT(assigned.doubts.at(0), Contains("--set material.friction=30"));
}

TEST_CASE("no shipped recipe is told to be in other units") {
  std::size_t recipes = 0;
  for (const char* folder : {"/protocols", "/protocols/soils"}) {
    for (const auto& entry : std::filesystem::directory_iterator(std::string(RVELAB_SOURCE_DIR) + folder)) {
      if (entry.path().extension() != ".toml" || !pack::is_recipe(entry.path().string())) continue;
      const pack::RecipeFile file = pack::read_recipe(entry.path().string());
      CAPTURE(entry.path().string(), file.doubts);
      CHECK(file.doubts.empty());
      ++recipes;
    }
  }
  CHECK(recipes > 12);
}

TEST_CASE("packings that take long are known beforehand: long blocks with sharp edges, and millions of grains") {
  const auto seconds = [](std::size_t number, const Vector3& half_axes, double exponent) {
    pack::Recipe recipe = test::spheres(number);
    if (exponent > 0) recipe.shape = Shape::superellipsoid;
    recipe.fractions[0].half_axes = half_axes;
    recipe.fractions[0].exponent_xy = recipe.fractions[0].exponent_z = exponent;
    return pack::expected_seconds(recipe);
  };
  CHECK(seconds(60, {10, 1, 1}, 20) > 600);
  CHECK(seconds(60, {10, 1, 1}, 2) < 1);
  CHECK(seconds(60, {10, 1, 1}, 4) < 60);
  CHECK(seconds(60, {1.25, 1, 0.8}, 4) < 60);
  CHECK(seconds(2000, {1.25, 1, 0.8}, 4) > 600);
  CHECK(seconds(1000, {1, 1, 1}, 0) < 10);
  CHECK(seconds(1'000'000, {1, 1, 1}, 0) > 3600);
}

TEST_CASE("hard and soft materials of analogue tests are usual") {
  // Steel and glass beads at 1 kPa, rubber balls at 2 kPa.
  CHECK(recipe_of("young_modulus_Pa = 210e9\npoisson_ratio = 0.3\nfriction = 0.1", "1e3", "hertz_mindlin",
                  "shape = \"sphere\"\nnumber = 300")
            .doubts.empty());
  CHECK(recipe_of("young_modulus_Pa = 70e9\nfriction = 0.1", "1e3", "linear", "shape = \"sphere\"\nnumber = 300")
            .doubts.empty());
  CHECK(recipe_of("young_modulus_Pa = 1e6\npoisson_ratio = 0.49\nfriction = 0.8", "2e3", "hertz_mindlin",
                  "shape = \"sphere\"\nnumber = 300")
            .doubts.empty());
}

TEST_CASE(
    "grains that do not come to rest are given up after a number of steps, and the message says how far they came") {
  pack::Recipe recipe = test::discs(60);
  Rve rve(pack::draw(recipe, 1, 0.2, nullptr).specimen);
  pack::StressGoal goal{pack::isotropic_stress(2e5, Shape::disc), true, 2};
  pack::StepsLeft left{0, 50};  // fewer than the way to twice the pressure takes
  Matrix3 deformation = Matrix3::Identity();
  CHECK_THROWS_WITH(pack::consolidate(rve, goal, {}, deformation, &left),
                    Contains("do not come to rest") && Contains("sub-steps the unbalanced ratio is") &&
                        Contains("void ratio 0.") && Contains("contacts a grain"));
  CHECK(left.made > 50);
  // With enough of them they do.
  left = {0, 10'000'000};
  CHECK(pack::consolidate(rve, goal, {}, deformation, &left));
}
