// Regular packings: numbers of rows, six contacts a grain, the bedding angle, what rows cannot be made of.
#include "rvelab/pack/regular.hpp"

#include <functional>

#include "rvelab/error.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/pack/search.hpp"
#include "rvelab/solver/rve.hpp"
#include "tests/catch.hpp"
#include "tests/pack/recipes.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

pack::Recipe rows(std::size_t number, double angle) {
  pack::Recipe recipe = ellipses(number);
  recipe.fractions[0].grading.smallest_radius = recipe.fractions[0].grading.largest_radius = 5e-3;
  recipe.fractions[0].bedding_angle = angle;
  recipe.fractions[0].bedding_spread = 0;
  recipe.preparation.method = pack::Preparation::Method::regular;
  return recipe;
}

}  // namespace

TEST_CASE("rows are chosen whose cell is nearest to a square, an even number of them") {
  const auto expect = [](std::size_t number, double aspect, std::size_t in_row, std::size_t of_them) {
    const pack::RowCounts found = pack::row_counts(number, aspect);
    CAPTURE(number, aspect, found.in_row, found.rows);
    CHECK(found.in_row == in_row);
    CHECK(found.rows == of_them);
  };
  expect(400, 0.743, 20, 20);
  expect(432, 0.743, 18, 24);  // the two numbers of Liang et al. (2023)
  expect(16, 1, 4, 4);
  expect(40, 0.1, 2, 20);
  for (const std::size_t number : {1, 2, 3, 5, 401}) expect(number, 0.743, 0, 0);
}

TEST_CASE("a regular packing has six contacts a grain, lies at its angle and bears its stress") {
  for (const double angle : {0.0, 30.0, -75.0}) {
    CAPTURE(angle);
    const pack::Recipe recipe = rows(48, angle);
    Workers alone(1);
    const pack::Packing packing = pack::pack(recipe, alone);
    const Rve rve(packing.specimen);
    const Network network = rve.network();
    CHECK(network.contacts.size() == 3 * network.grains.size());
    CHECK((rve.stress() - *recipe.stress).cwiseAbs().maxCoeff() < 1e-3 * 1e5);
    CHECK(rve.unbalanced_ratio() < 1e-5);
    for (const GrainState& grain : network.grains) {
      const Vector3 axis = network.cell.rotation * grain.orientation;
      CHECK(std::abs(std::remainder(std::atan2(axis[1], axis[0]) * 180 / 3.14159265358979323846 - angle, 180)) < 0.01);
    }
    // Stretching changes no void ratio: that of the triangular lattice, less what the overlaps take.
    CHECK(packing.void_ratio < 2 * std::sqrt(3.0) / 3.14159265358979323846 - 1);
    CHECK(packing.void_ratio > 0.098);
  }
}

TEST_CASE("what rows cannot be made of is refused by name") {
  const auto refused = [](const std::function<void(pack::Recipe&)>& change, const std::string& text) {
    pack::Recipe recipe = rows(48, 0);
    CHECK_NOTHROW(pack::check_recipe(recipe));
    change(recipe);
    CHECK_THROWS_WITH(pack::check_recipe(recipe), Contains(text));
  };
  using Recipe = pack::Recipe;
  refused([](Recipe& r) { r.number = 401; }, "pack.number = 401 makes no rows");
  refused([](Recipe& r) { r.number = 401; }, "take 400");
  refused([](Recipe& r) { r.oriented = true; }, "pack.cell = \"oriented\" contradicts");
  refused([](Recipe& r) { r.void_ratio = 0.1; }, "target.void_ratio contradicts");
  refused([](Recipe& r) { r.stress.reset(), r.void_ratio = 0.1; }, "target.pressure_Pa is missing");
  refused([](Recipe& r) { r.fractions[0].bedding_spread = 10; }, "bedding_spread_deg = 10 contradicts");
  refused([](Recipe& r) { r.fractions[0].grading.largest_radius = 6e-3; }, "grains of one size and form");
  refused([](Recipe& r) { r.fractions[0].largest_aspect_ratio = 0.9; }, "grains of one size and form");
  refused([](Recipe& r) { r.shape = Shape::sphere; }, "pack.shape = \"sphere\" contradicts");
}
