// Specimens of clumps as a user gets them.
#include <cmath>
#include <set>

#include "rvelab/error.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/pack/draw.hpp"
#include "rvelab/pack/read_recipe.hpp"
#include "rvelab/pack/repeated.hpp"
#include "rvelab/solver/rve.hpp"
#include "tests/catch.hpp"
#include "tests/pack/recipes.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

pack::Recipe recipe_of_clumps(pack::Recipe recipe, const char* name) {
  recipe.clumps = true;
  for (pack::GrainFraction& fraction : recipe.fractions)
    fraction.clump = published_clump(name, dimension_of(recipe.shape));
  return recipe;
}

const std::string clump_recipe = R"([pack]
name = "clumps"
shape = "clump"
members = "sphere"
[grains]
smallest_radius_m = 1e-3
largest_radius_m = 2e-3
[target]
pressure_Pa = 1e5
[[material]]
name = "m"
density_kg_m3 = 2650
young_modulus_Pa = 1e8
stiffness_ratio = 0.5
friction = 0.5
[contact]
law = "linear"
)";

}  // namespace

TEST_CASE("clumps are packed to a pressure, at rest, with the volumes of their grading") {
  for (const pack::Recipe& recipe :
       {recipe_of_clumps(discs(60), "triangle"), recipe_of_clumps(spheres(30), "tetrapod")}) {
    const int d = dimension_of(recipe.shape);
    const pack::Draw made = pack::draw(recipe, 1, 0.1, nullptr);
    REQUIRE(made.at_rest);
    const Rve rve(made.specimen);
    const Network network = rve.network();
    CHECK(std::abs(mean_pressure(rve.stress(), d) - 1e5) < 100);
    CHECK(rve.unbalanced_ratio() < 1e-5);
    CHECK(network.grains.size() == recipe.number);
    CHECK(network.members.size() == recipe.number * (d == 2 ? 3 : 4));
    CHECK(std::abs(void_ratio(network) - made.void_ratio) < 1e-12);
    CHECK(coordination_number(network) > d + 1);  // frictional grains
    for (const GrainState& grain : network.grains) {
      CHECK(grain.radius > recipe.fractions[0].grading.smallest_radius * (1 - 1e-9));
      CHECK(grain.radius < recipe.fractions[0].grading.largest_radius * (1 + 1e-9));
    }
    // Two bodies may have several contacts.
    std::set<std::pair<std::int32_t, std::int32_t>> pairs;
    for (const ContactState& contact : network.contacts) pairs.insert(std::minmax(contact.i, contact.j));
    CHECK(pairs.size() < network.contacts.size());
    // The same bits again, and eight (four) of the cell are that cell.
    CHECK(Rve(pack::draw(recipe, 1, 0.1, nullptr).specimen).save() == rve.save());
    const Rve many(pack::repeated(made.specimen, {2, 2, d == 2 ? 1 : 2}));
    CHECK((many.stress() - rve.stress()).norm() < 1e-9 * 1e5);
    CHECK(std::abs(void_ratio(many.network()) - made.void_ratio) < 1e-9);
  }
}

TEST_CASE("a recipe of clumps mixes shapes, and says what it cannot make") {
  const pack::RecipeFile file = pack::parse_recipe(clump_recipe, "clumps.toml", {"grains.clump=elongated"});
  CHECK(file.recipe.clumps);
  CHECK(file.recipe.shape == Shape::sphere);
  REQUIRE(file.recipe.fractions[0].clump);
  CHECK(file.recipe.fractions[0].clump->members.size() == 4);
  CHECK(file.recipe.fractions[0].clump->extents[0] / file.recipe.fractions[0].clump->extents[2] == Approx(2.5));
  const auto refuses = [](const std::vector<std::string>& assignments, const char* text) {
    CHECK_THROWS_WITH(pack::parse_recipe(clump_recipe, "clumps.toml", assignments), Contains(text));
  };
  refuses({"grains.clump=pebble"}, "pair, triangle");
  refuses({"grains.clump=nowhere.csv"}, "cannot be read");
  refuses({"pack.members=disc", "grains.clump=tetrapod"}, "is not known");
  refuses({"pack.shape=sphere"}, "shape = \"clump\"");
  refuses({"preparation.method=growth"}, "compression");
}
