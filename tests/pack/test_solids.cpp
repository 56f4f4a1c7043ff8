// Specimens of ellipsoids and superellipsoids as a user gets them.
#include <cmath>

#include "rvelab/error.hpp"
#include "rvelab/pack/read_recipe.hpp"
#include "rvelab/pack/scatter.hpp"
#include "rvelab/specimen/solids.hpp"
#include "tests/pack/recipes.hpp"
#include "tests/refusal.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

pack::Recipe recipe_of(std::size_t number, double e, double n) {
  pack::Recipe recipe = spheres(number);
  recipe.shape = Shape::superellipsoid;
  for (pack::GrainFraction& fraction : recipe.fractions) {
    fraction.half_axes = {1.25, 1, 0.8};
    fraction.exponent_xy = e;
    fraction.exponent_z = n;
  }
  return recipe;
}

const std::string solid_recipe =
    recipe_text("name = \"solids\"\nshape = \"ellipsoid\"\n", "half_axes = [2.5, 2, 1.6]\n");

}  // namespace

TEST_CASE("ellipsoids and superellipsoids are packed to a pressure, at rest, with the volumes of their grading") {
  for (const pack::Recipe& recipe : {recipe_of(40, 2, 2), recipe_of(24, 4, 3)}) {
    const pack::Draw made = check_packed(recipe);
    const Network network = Rve(made.specimen).network();
    double solid = 0;
    for (std::size_t g = 0; g < recipe.number; ++g) {
      const Superellipsoid s = superellipsoid_of(made.specimen.grains, g);
      CHECK(s.a / s.c == Approx(1.25 / 0.8).epsilon(1e-12));
      const double r = network.grains[g].radius;
      CHECK(volume_of(s) == Approx(4 * std::acos(-1.0) / 3 * r * r * r).epsilon(1e-12));
      solid += volume_of(s);
    }
    CHECK(void_ratio(network) == Approx(network.cell.volume() / solid - 1).epsilon(1e-10));
    // Eight of the cell are that cell on the way too.
    Specimen one = made.specimen, eight = pack::repeated(made.specimen, {2, 2, 2});
    one.solver.fixed_substeps = eight.solver.fixed_substeps = 50;
    Rve alone(one), many(eight);
    Matrix3 gradient = Matrix3::Zero();
    gradient(0, 0) = -5e-5;
    gradient(0, 1) = 3e-5;
    for (Rve* each : {&alone, &many}) each->apply(gradient, 0);
    CHECK((many.stress() - alone.stress()).norm() < 1e-8 * 1e5);
    CHECK(std::abs(void_ratio(many.network()) - void_ratio(alone.network())) < 1e-9);
  }
}

TEST_CASE("bedded ellipsoids lie within the angle that is asked for, others everywhere") {
  const auto upright = [](double spread) {
    pack::Recipe recipe = recipe_of(60, 2, 2);
    recipe.fractions[0].bedding_spread = spread;
    recipe.preparation.friction = 0.5;
    const pack::RecipeFile file =
        pack::parse_recipe(solid_recipe, "solids.toml", {"grains.bedding_spread_deg=" + std::to_string(spread)});
    CHECK(file.recipe.fractions[0].bedding_spread == spread);
    Uniform uniform(1);
    Specimen s;
    s.shape = Shape::superellipsoid;
    put_solids(recipe, pack::graded_grains(recipe), uniform, s);
    double least = 1, mean = 0;
    for (const Body& body : s.bodies) {
      const double cosine = std::abs(axes_of(body.orientation)(2, 2));
      least = std::min(least, cosine);
      mean += cosine / 60;
    }
    return std::pair{least, mean};
  };
  const double limit = std::cos(20 * std::acos(-1.0) / 180);
  CHECK(upright(20).first > limit - 1e-12);
  CHECK(upright(20).first < limit + 0.2 * (1 - limit));
  CHECK(std::abs(upright(90).second - 0.5) < 0.15);  // four standard deviations of 60 cosines
}

TEST_CASE("a recipe of ellipsoids reads half axes and exponents, and says what it cannot make") {
  const pack::RecipeFile file = pack::parse_recipe(solid_recipe, "solids.toml", {});
  CHECK(file.recipe.shape == Shape::superellipsoid);
  CHECK(file.recipe.fractions[0].exponent_z == 2);
  const pack::RecipeFile blocks =
      pack::parse_recipe(solid_recipe, "solids.toml", {"pack.shape=superellipsoid", "grains.exponents=[4, 8]"});
  CHECK(blocks.recipe.fractions[0].exponent_xy == 4);
  CHECK(blocks.recipe.fractions[0].exponent_z == 8);
  CHECK(pack::parse_recipe(blocks.resolved, "again.toml", {}).recipe.fractions[0].exponent_z == 8);
  const auto refuses = [](const std::vector<std::string>& assignments, const char* text) {
    CHECK_THROWS_WITH(pack::parse_recipe(solid_recipe, "solids.toml", assignments), Contains(text));
  };
  refuses({"grains.exponents=[4, 4]"}, "\"superellipsoid\"");
  refuses({"pack.shape=superellipsoid"}, "exponents");
  refuses({"pack.shape=superellipsoid", "grains.exponents=[4, 40]"}, "exponents");
  refuses({"grains.half_axes=[1, 2]"}, "three numbers");
  refuses({"grains.half_axes=[1, 2, 30]"}, "10 times");
  for (const char* half : {"grains.half_axes=[1, nan, 2]", "grains.half_axes=[nan, 1, nan]"}) {
    const std::string said = input_error([&] { pack::parse_recipe(solid_recipe, "solids.toml", {half}); });
    CAPTURE(said);
    CHECK(said.find("is not finite") != std::string::npos);
    CHECK(said.find("grains.half_axes = ") == said.rfind("grains.half_axes = "));  // told once
  }
  refuses({"pack.shape=sphere"}, "half_axes");
  refuses({"grains.smallest_aspect_ratio=0.5"}, "ellipses");
  refuses({"preparation.method=growth"}, "compression");
  refuses({"pack.thickness_m=0.1"}, "2D only");
}
