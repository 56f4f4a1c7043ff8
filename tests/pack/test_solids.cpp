// Specimens of ellipsoids and superellipsoids as a user gets them.
#include <cmath>

#include "rvelab/error.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/pack/draw.hpp"
#include "rvelab/pack/read_recipe.hpp"
#include "rvelab/pack/repeated.hpp"
#include "rvelab/pack/scatter.hpp"
#include "rvelab/solver/rve.hpp"
#include "rvelab/specimen/solids.hpp"
#include "tests/catch.hpp"
#include "tests/pack/recipes.hpp"

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

const std::string solid_recipe = R"([pack]
name = "solids"
shape = "ellipsoid"
[grains]
half_axes = [2.5, 2, 1.6]
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

TEST_CASE("ellipsoids and superellipsoids are packed to a pressure, at rest, with the volumes of their grading") {
  for (const pack::Recipe& recipe : {recipe_of(40, 2, 2), recipe_of(24, 4, 3)}) {
    const pack::Draw made = pack::draw(recipe, 1, 0.1, nullptr);
    REQUIRE(made.at_rest);
    const Rve rve(made.specimen);
    const Network network = rve.network();
    CHECK(std::abs(mean_pressure(rve.stress(), 3) - 1e5) < 100);
    CHECK(rve.unbalanced_ratio() < 1e-5);
    CHECK(network.grains.size() == recipe.number);
    CHECK(coordination_number(network) > 4);  // frictional grains
    double solid = 0;
    for (std::size_t g = 0; g < recipe.number; ++g) {
      const Superellipsoid s = superellipsoid_of(made.specimen.grains, g);
      CHECK(s.a / s.c == Approx(1.25 / 0.8).epsilon(1e-12));
      const double r = network.grains[g].radius;
      CHECK(volume_of(s) == Approx(4 * std::acos(-1.0) / 3 * r * r * r).epsilon(1e-12));
      CHECK(r > recipe.fractions[0].grading.smallest_radius * (1 - 1e-9));
      CHECK(r < recipe.fractions[0].grading.largest_radius * (1 + 1e-9));
      solid += volume_of(s);
    }
    CHECK(void_ratio(network) == Approx(network.cell.volume() / solid - 1).epsilon(1e-10));
    // The same bits again, and eight of the cell are that cell, on the way too.
    CHECK(Rve(pack::draw(recipe, 1, 0.1, nullptr).specimen).save() == rve.save());
    Specimen one = made.specimen, eight = pack::repeated(made.specimen, {2, 2, 2});
    one.solver.fixed_substeps = eight.solver.fixed_substeps = 50;
    Rve alone(one), many(eight);
    CHECK((many.stress() - alone.stress()).norm() < 1e-9 * 1e5);
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
  refuses({"pack.shape=sphere"}, "half_axes");
  refuses({"grains.smallest_aspect_ratio=0.5"}, "ellipses");
  refuses({"preparation.method=growth"}, "compression");
  refuses({"pack.thickness_m=0.1"}, "2D only");
}
