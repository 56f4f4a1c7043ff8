// The curve of void ratio against friction, and where it meets a target.
#include <algorithm>

#include "rvelab/error.hpp"
#include "rvelab/pack/search.hpp"
#include "rvelab/solver/rve.hpp"
#include "tests/catch.hpp"
#include "tests/pack/recipes.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

TEST_CASE("coordinates and frictions belong to each other over the whole range") {
  CHECK(pack::coordinate_of(0) == 0);
  CHECK(pack::coordinate_of(0.1) == 0.5);
  for (const double friction : {1e-6, 0.02, 0.3, 1.0, 50.0, 1e6})
    CHECK(pack::friction_of(pack::coordinate_of(friction)) == Approx(friction).epsilon(1e-8));
}

TEST_CASE("a fit through points on a rising line meets the target on it; beyond them it goes to the ends") {
  const std::vector<pack::CurvePoint> line{{0.8, 0.24}, {0.2, 0.18}, {0.6, 0.22}, {0.4, 0.20}};
  CHECK(pack::fitted_coordinate(line, 0.21, 0, 1) == Approx(0.5));
  CHECK(pack::fitted_coordinate(line, 0.185, 0, 1) == Approx(0.25));
  CHECK(pack::fitted_coordinate(line, 0.17, 0.1, 1) == 0.1);
  CHECK(pack::fitted_coordinate(line, 0.25, 0, 0.9) == 0.9);
}

TEST_CASE("a close cluster off the curve counts by its mean, not by its lucky points") {
  // True curve 0.17 + 0.1 x; the cluster at 0.5 scatters by +-0.004 about 0.22.
  std::vector<pack::CurvePoint> points{{0.125, 0.1825}, {0.375, 0.2075}, {0.625, 0.2325}, {0.875, 0.2575}};
  for (int k = 0; k < 8; ++k) points.push_back({0.495 + 0.00125 * k, 0.22 + (k % 2 == 0 ? -0.004 : 0.004)});
  CHECK(pack::fitted_coordinate(points, 0.22, 0, 1) == Approx(0.5).margin(0.01));
  CHECK(pack::fitted_coordinate(points, 0.217, 0, 1) == Approx(0.47).margin(0.01));
  CHECK(pack::fitted_coordinate(points, 0.223, 0, 1) == Approx(0.53).margin(0.01));
}

TEST_CASE("a curve that falls by chance does not send the search away") {
  const std::vector<pack::CurvePoint> falling{{0.1, 0.22}, {0.3, 0.22}, {0.5, 0.21}, {0.9, 0.20}};
  for (const double target : {0.19, 0.21, 0.23}) {
    const double at = pack::fitted_coordinate(falling, target, 0, 1);
    CHECK((at >= 0 && at <= 1));
  }
}

TEST_CASE("a search has the same bits on any number of threads") {
  pack::Recipe recipe = discs(60);
  recipe.void_ratio = 0.21;
  recipe.void_ratio_tolerance = 2e-3;
  Workers one(1);
  const pack::Packing alone = pack::pack(recipe, one);
  CHECK(std::abs(alone.void_ratio - 0.21) <= 2e-3);
  const auto bits = Rve(alone.specimen).save();
  for (const unsigned threads : {2u, 3u, 5u}) {
    Workers workers(threads);
    const pack::Packing other = pack::pack(recipe, workers);
    CHECK(other.draw == alone.draw);
    CHECK(other.preparation_friction == alone.preparation_friction);
    CHECK(Rve(other.specimen).save() == bits);
  }
}

TEST_CASE("a void ratio out of reach is told with the range that was reached, and what to do") {
  pack::Recipe recipe = discs(60);
  Workers workers(1);
  for (const double target : {0.1, 0.5}) {
    recipe.void_ratio = target;
    long draws = 0;
    pack::PackWatch watch;
    watch.on_draw = [&](long, double) { ++draws; };
    std::string message;
    try {
      pack::pack(recipe, workers, watch);
    } catch (const InputError&) {
      FAIL("the file is right; the packing is not there");
    } catch (const Error& error) {
      message = error.what();
    }
    INFO(message);
    CHECK_THAT(message, Contains("was not met within 0.001 in ") && Contains(" packings; reached: 0.") &&
                            Contains("preparation friction"));
    CHECK(draws <= 16);  // of the hundred that it may take
    CHECK_THAT(message, Contains(target < 0.2 ? "give a higher void ratio" : "give a lower void ratio"));
  }
}

TEST_CASE("a tolerance below the usual one is met too, with more packings") {
  pack::Recipe recipe = discs(60);
  recipe.void_ratio = 0.21;
  recipe.void_ratio_tolerance = 3e-4;
  recipe.preparation.max_draws = 2000;
  Workers workers(1);
  CHECK(std::abs(pack::pack(recipe, workers).void_ratio - 0.21) <= 3e-4);
}

TEST_CASE("a stop ends a search within its draws") {
  pack::Recipe recipe = discs(60);
  recipe.void_ratio = 0.1;
  std::atomic<bool> stop{false};
  long draws = 0;
  pack::PackWatch watch;
  watch.stop = &stop;
  watch.on_draw = [&](long, double) { stop = ++draws == 3; };
  Workers workers(1);
  CHECK_THROWS_AS(pack::pack(recipe, workers, watch), Interrupted);
  CHECK(draws == 3);
}
