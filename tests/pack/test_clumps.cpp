// Specimens of clumps as a user gets them.
#include <set>

#include "rvelab/error.hpp"
#include "rvelab/pack/read_recipe.hpp"
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

const std::string clump_recipe = recipe_text("name = \"clumps\"\nshape = \"clump\"\nmembers = \"sphere\"\n", "");

}  // namespace

TEST_CASE("clumps are packed to a pressure, at rest, with the volumes of their grading") {
  for (const pack::Recipe& recipe :
       {recipe_of_clumps(discs(60), "triangle"), recipe_of_clumps(spheres(30), "tetrapod")}) {
    const int d = dimension_of(recipe.shape);
    const Network network = Rve(check_packed(recipe).specimen).network();
    CHECK(network.members.size() == recipe.number * (d == 2 ? 3 : 4));
    // Two bodies may have several contacts.
    std::set<std::pair<std::int32_t, std::int32_t>> pairs;
    for (const ContactState& contact : network.contacts) pairs.insert(std::minmax(contact.i, contact.j));
    CHECK(pairs.size() < network.contacts.size());
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
