// Recipes: every key is read, every mistake told, families and shipped recipes.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <regex>

#include "rvelab/keys/material_toml.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/pack/read_recipe.hpp"
#include "tests/catch.hpp"
#include "tests/refusal.hpp"

using namespace rvelab;
using Catch::Matchers::Contains;

namespace {

const char* const small = R"([pack]
name = "small"
[grains]
smallest_radius_m = 3e-3
largest_radius_m = 7e-3
[target]
pressure_Pa = 1e5
[[material]]
name = "sand"
young_modulus_Pa = 8e8
friction = 0.4
)";

const char* const mixture = R"([pack]
name = "mixture"
shape = "sphere"
share_by = "mass"
[[grains]]
name = "coarse"
material = "rock"
share = 0.25
grading = "tabulated"
radii_m = [5e-3, 6e-3]
passing = [0, 1]
passing_by = "mass"
[[grains]]
name = "fine"
share = 0.75
grading = "linear"
smallest_radius_m = 1e-3
largest_radius_m = 2e-3
[target]
stress_Pa = [-100, -80, -120, 1, 2, 3]
pressures_Pa = [1e4, 2e4]
void_ratio = 0.5
[preparation]
method = "growth"
[contact]
law = "hertz_mindlin"
[[material]]
name = "sand"
young_modulus_Pa = 7e9
poisson_ratio = 0.25
friction = 0.5
[[material]]
name = "rock"
density_kg_m3 = 2700
young_modulus_Pa = 50e9
poisson_ratio = 0.2
friction = 0.3
)";

std::string message_of(const std::string& text, const std::vector<std::string>& assignments = {}) {
  return test::input_error([&] { pack::parse_recipe(text, "r.toml", assignments); });
}

}  // namespace

TEST_CASE("a small recipe has the defaults that the key table states") {
  const pack::RecipeFile file = pack::parse_recipe(small, "r.toml");
  const auto resolved = toml::parse(file.resolved);
  for (const keys::Key& key : pack::recipe_keys()) {
    CAPTURE(key.dotted());
    const toml::node* node = resolved[key.table].is_array() ? (*resolved["grains"][0].as_table()).get(key.name)
                                                            : resolved[key.table][key.name].node();
    if (key.name == "members" || key.name == "clump") continue;                                     // clumps
    if (key.name == "first_size") continue;                                                         // growth only
    if (key.name.find("aspect") != std::string::npos || key.name.starts_with("bedding")) continue;  // ellipses
    if (key.initial.empty() || key.initial[0] == '(') continue;                                     // none, or in words
    const auto stated = toml::parse("initial = " + key.initial);
    const toml::node& initial = *stated.get("initial");
    REQUIRE(node != nullptr);
    if (key.type == "number") CHECK(node->value<double>() == initial.value<double>());
    if (key.type == "whole number") CHECK(node->value<std::int64_t>() == initial.value<std::int64_t>());
    if (key.type == "choice" || key.type == "text") CHECK(node->value<std::string>() == initial.value<std::string>());
  }
  CHECK(file.name == "small");
  CHECK(file.recipe.number == 400);
  CHECK(file.recipe.fractions.at(0).grading.largest_radius == 7e-3);
  CHECK(file.recipe.materials.at(0).friction == 0.4);
  CHECK(*file.recipe.stress == pack::isotropic_stress(1e5, Shape::disc));
  CHECK(!file.recipe.void_ratio);
  // What was read can be read again, with the same meaning.
  CHECK(pack::parse_recipe(file.resolved, "again.toml").resolved == file.resolved);
}

TEST_CASE("a mixture of two materials, gradings and a stress tensor comes out as it was written") {
  const pack::RecipeFile file = pack::parse_recipe(mixture, "r.toml");
  const pack::Recipe& recipe = file.recipe;
  REQUIRE(recipe.fractions.size() == 2);
  CHECK(recipe.fractions[0].material == 1);
  CHECK(recipe.fractions[1].material == 0);
  CHECK(recipe.fractions[0].grading.by_mass);
  CHECK(recipe.fractions[0].grading.curve == GradingCurve::tabulated);
  CHECK(recipe.fractions[1].grading.curve == GradingCurve::linear);
  CHECK(recipe.share_by_mass);
  CHECK(recipe.preparation.method == pack::Preparation::Method::growth);
  CHECK(pack::growth_void_ratio(recipe) == Approx(0.6));
  // A family scales the tensor to each mean pressure.
  REQUIRE(file.pressures == std::vector<double>{1e4, 2e4});
  const pack::RecipeFile member = file.member(9, 2e4);
  const pack::Recipe& second = member.recipe;
  const pack::RecipeFile again = pack::parse_recipe(member.resolved, "again.toml");
  CHECK(again.recipe.seed == 9);
  CHECK(*again.recipe.stress == *second.stress);
  CHECK(second.seed == 9);
  CHECK(mean_pressure(*second.stress, 3) == Approx(2e4));
  CHECK((*second.stress)(1, 2) == Approx(200));
  CHECK((*second.stress)(0, 2) == Approx(400));
  CHECK((*second.stress)(0, 1) == Approx(600));
  CHECK((*second.stress)(2, 2) == Approx(-24000));
}

TEST_CASE("a recipe of ellipses says their aspect ratios and bedding") {
  const pack::RecipeFile file =
      pack::parse_recipe(small, "r.toml",
                         {"pack.shape=ellipse", "grains.smallest_aspect_ratio=0.4", "grains.largest_aspect_ratio=0.8",
                          "grains.bedding_angle_deg=30", "grains.bedding_spread_deg=15"});
  CHECK(file.recipe.shape == Shape::ellipse);
  const pack::GrainFraction& fraction = file.recipe.fractions.at(0);
  CHECK(fraction.smallest_aspect_ratio == 0.4);
  CHECK(fraction.largest_aspect_ratio == 0.8);
  CHECK(fraction.bedding_angle == 30);
  CHECK(fraction.bedding_spread == 15);
  CHECK(pack::parse_recipe(file.resolved, "again.toml").resolved == file.resolved);
}

TEST_CASE("a law of --set leaves out what the law of the file reads, so that the recipe in the specimen is one") {
  const std::string linear = small + std::string("stiffness_ratio = 0.5\n");
  const pack::RecipeFile file =
      pack::parse_recipe(linear, "r.toml", {"contact.law=hertz_mindlin", "material.poisson_ratio=0.2"});
  CHECK(file.recipe.materials[0].stiffness_ratio == 0);
  CHECK(file.recipe.materials[0].young_modulus > 0);
  CHECK(file.resolved.find("stiffness_ratio") == std::string::npos);
  CHECK(pack::parse_recipe(file.resolved, "again.toml").resolved == file.resolved);
  CHECK_THAT(message_of(linear, {"contact.law=hertz_mindlin", "material.stiffness_ratio=1"}),
             Contains("material.stiffness_ratio does not go with contact.law = hertz_mindlin"));
}

TEST_CASE("porosity and void ratio say the same") {
  const auto with = [](const std::string& assignment) {
    return *pack::parse_recipe(small, "r.toml", {assignment}).recipe.void_ratio;
  };
  CHECK(with("target.porosity=0.2") == Approx(0.25));
  CHECK(with("target.void_ratio=0.25") == 0.25);
}

TEST_CASE("every mistake of a recipe is told at once, with its line and what is allowed") {
  const std::string message = message_of(R"([pack]
name = "wrong"
number = 0
shap = "disc"
[grains]
smallest_radius_m = 7e-3
largest_radius_m = 3e-3
material = "gravel"
[target]
pressure_kPa = 100
stress_Pa = [-1e5, -1e5]
void_ratio = "loose"
[preparation]
lowest_friction = 1
highest_friction = 0.5
first_size = 0.3
[[material]]
name = "sand"
young_modulus_Pa = -1
)");
  INFO(message);
  for (const char* part :
       {"r.toml:3: pack.number = 0 is out of range; allowed: 1 to 1e+08",
        "r.toml:4: unknown key pack.shap; the nearest known key is pack.shape",
        "grains.smallest_radius_m = 0.007 and grains.largest_radius_m = 0.003",
        "r.toml:8: grains.material = 'gravel' is no material of the recipe; allowed: sand",
        "r.toml:10: target.pressure_kPa is not known; write target.pressure_Pa, 1 kPa = 1000 Pa",
        "r.toml:11: target.stress_Pa = [ -100000.0, -100000.0 ] is not a stress in 2D; allowed: [xx, yy, xy]",
        "r.toml:12: target.void_ratio = 'loose' is not a number",
        "r.toml:15: preparation.highest_friction = 0.5 is not above preparation.lowest_friction",
        "r.toml:19: material.young_modulus_Pa = -1 is out of range"})
    CHECK_THAT(message, Contains(part));
}

TEST_CASE("a message names each key of a recipe by its table and name, and no table twice") {
  const std::regex doubled(R"((^|[^.\w])(\w+)\.\2\.)");
  const auto check = [&](const std::string& message, const std::string& key) {
    INFO(message);
    CHECK_THAT(message, Contains(key));
    CHECK(!std::regex_search(message, doubled));
  };
  std::vector<keys::Key> all = pack::recipe_keys();
  all.insert(all.end(), keys::known_keys().begin(), keys::known_keys().end());
  REQUIRE(all.size() > 60);
  for (const keys::Key& key : all) {
    check(message_of(small, {key.dotted() + "=1979-05-27"}), key.dotted() + " = ");  // no key takes a day
    check(message_of(small, {key.dotted() + "x=1"}), "unknown key " + key.dotted());
  }
  // What is found once all keys are read.
  const std::string table = "grains.grading=tabulated";
  const std::string bare = std::string(small).erase(std::string(small).find("smallest"), 49);
  check(message_of(bare, {table, "grains.passing=[0, 1]"}), "grains.radii_m has 0 values");
  check(message_of(bare, {table, "grains.radii_m=[2e-3, 1e-3]", "grains.passing=[0, 1]"}),
        "grains.radii_m is not ascending");
  check(message_of(bare, {table, "grains.radii_m=[1e-3, 2e-3]", "grains.passing=[0.1, 1]"}),
        "grains.passing does not rise");
  check(message_of(small, {"preparation.method=regular"}), "grains: preparation.method");
  const std::string lying = "grains.bedding_spread_deg=10", equal = "grains.largest_radius_m=3e-3";
  check(message_of(small, {"preparation.method=regular", "pack.shape=ellipse", lying, equal}),
        "grains.bedding_spread_deg = 10 contradicts");
  // A fraction with a name of its own has it in every message.
  check(message_of(mixture, {"grains.fine.smallest_radius_m=5e-3"}), "grains.fine.smallest_radius_m = 0.005");
  check(message_of(mixture, {"grains.fine.bedding_angle_deg=5"}), "grains.fine.bedding_angle_deg = 5");
}

TEST_CASE("what contradicts something else is refused by name") {
  CHECK_THAT(message_of(small, {"target.stress_Pa=[-1, -1, 0]"}), Contains("contradicts target.pressure_Pa"));
  CHECK_THAT(message_of(small, {"target.pressures_Pa=[1e4]"}), Contains("contradicts target.pressure_Pa"));
  CHECK_THAT(message_of(small, {"target.void_ratio=0.2", "target.porosity=0.2"}),
             Contains("contradicts target.void_ratio"));
  CHECK_THAT(message_of(small, {"target.void_ratio=0.2", "preparation.friction=0.1"}),
             Contains("contradicts target.void_ratio, for which the friction is searched"));
  CHECK_THAT(message_of(small, {"grains.radii_m=[1e-3, 2e-3]"}), Contains("contradicts grading = \"uniform\""));
  CHECK_THAT(message_of(small, {"preparation.first_size=0.3"}), Contains("contradicts method = \"compression\""));
  CHECK_THAT(message_of(mixture, {"pack.thickness_m=0.1"}), Contains("contradicts pack.shape = \"sphere\""));
  CHECK_THAT(message_of(small, {"grains.share=0.5"}), Contains("add up to 0.5; allowed: 1"));
  for (const char* key : {"smallest_aspect_ratio", "largest_aspect_ratio", "bedding_angle_deg", "bedding_spread_deg"})
    CHECK_THAT(message_of(small, {std::string("grains.") + key + "=0.5"}),
               Contains("contradicts pack.shape = \"disc\""));
  CHECK_THAT(message_of(small, {"pack.shape=ellipse", "grains.largest_aspect_ratio=0.5"}),
             Contains("is above grains.largest_aspect_ratio"));
  CHECK_THAT(message_of(mixture, {"grains.share=0.5"}),
             Contains("names no grains; allowed: 0 (coarse), 1 (fine); give the name or the number of one"));
  const std::string regular = "preparation.method=regular";
  CHECK_THAT(message_of(small, {regular}), Contains("grains of one size and form"));
  CHECK_THAT(message_of(small, {regular, "preparation.first_size=0.3"}), Contains("contradicts method = \"regular\""));
}

TEST_CASE("a relative density lies between the limits of the recipe, and d10, d50 and d60 make a grading") {
  const pack::RecipeFile dense =
      pack::parse_recipe(small, "r.toml", {"target.relative_density=0.75", "target.e_min=0.16", "target.e_max=0.24"});
  CHECK(*dense.recipe.void_ratio == Approx(0.24 - 0.75 * 0.08));
  // What was resolved reads as the same recipe again.
  CHECK(*pack::parse_recipe(dense.resolved, "r.toml").recipe.void_ratio == *dense.recipe.void_ratio);
  CHECK_THAT(message_of(small, {"target.relative_density=0.75", "target.e_min=0.16"}), Contains("needs target.e_min"));
  CHECK_THAT(message_of(small, {"target.relative_density=0.7", "target.e_min=0.3", "target.e_max=0.2"}),
             Contains("needs target.e_min below target.e_max"));
  CHECK_THAT(message_of(small, {"target.relative_density=0.7", "target.e_min=0.1", "target.e_max=0.2",
                                "target.void_ratio=0.2"}),
             Contains("contradicts target.void_ratio"));
  std::string sieved = small;
  const auto at = sieved.find("smallest_radius_m"), end = sieved.find("\n", sieved.find("largest_radius_m"));
  REQUIRE(at < end);
  sieved.replace(at, end - at, "grading = \"d10_d60\"\nd10_mm = 5\nd50_mm = 7\nd60_mm = 7.6");
  const auto grains = sieved.find("grading = \"uniform\"\n");
  if (grains != std::string::npos) sieved.erase(grains, std::string("grading = \"uniform\"\n").size());
  CHECK(message_of(sieved).empty());
  const pack::RecipeFile of_sieves = pack::parse_recipe(sieved, "r.toml", {"grains.scalp_above_mm=9"});
  CHECK(of_sieves.recipe.fractions[0].grading.by_mass);
  CHECK(of_sieves.recipe.fractions[0].grading.scalp_above == Approx(4.5e-3));
  CHECK(pack::parse_recipe(of_sieves.resolved, "again.toml").resolved == of_sieves.resolved);
  CHECK_THAT(message_of(sieved, {"grains.d50_mm=8"}), Contains("does not lie between d10 and d60"));
  CHECK_THAT(message_of(sieved, {"grains.passing_by=number"}), Contains("contradicts grading = \"d10_d60\""));
  CHECK_THAT(message_of(small, {"grains.d50_mm=7"}), Contains("contradicts grading = \"uniform\""));
}

TEST_CASE("stresses beyond those of any solid, which no packing would come to, are refused") {
  CHECK_THAT(message_of(small, {"target.pressure_Pa=1e16"}), Contains("is out of range; allowed: above 0 to 1e+15 Pa"));
  CHECK_THAT(message_of(small, {"target.pressures_Pa=[1e4, 1e16]"}), Contains("above 0 to 1e+15"));
  CHECK_THAT(message_of(small, {"target.stress_Pa=[-1e16, -1e16, 0]"}), Contains("-1e+15 to 1e+15"));
}

TEST_CASE("what a recipe cannot do without is asked for") {
  const std::string message = message_of("[pack]\nname = \"nothing\"\n");
  INFO(message);
  CHECK_THAT(message, Contains("the recipe has no grains") && Contains("the recipe has no material") &&
                          Contains("target.pressure_Pa is missing, and so is target.void_ratio"));
  CHECK_THAT(message_of("[test]\nname = \"x\"\n"), Contains("unknown key test") && Contains("pack.name is missing"));
}

TEST_CASE("every shipped recipe is one, and says in its head what it is and where its numbers are from") {
  std::size_t recipes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(RVELAB_SOURCE_DIR "/protocols")) {
    if (entry.path().extension() != ".toml") continue;  // studies, README
    const std::string path = entry.path().string(), name = entry.path().stem().string();
    CAPTURE(path);
    CHECK(pack::is_recipe(path) == name.starts_with("pack_"));
    if (!pack::is_recipe(path)) continue;
    ++recipes;
    const pack::RecipeFile file = pack::read_recipe(path);
    CHECK(file.recipe.number >= 400);
    std::ifstream input(path);
    const std::string text{std::istreambuf_iterator<char>(input), {}};
    CHECK(text.starts_with("# "));
    CHECK_THAT(text, Contains("# Sources.") && Contains("rvelab pack " + name));
  }
  CHECK(recipes >= 10);
}
