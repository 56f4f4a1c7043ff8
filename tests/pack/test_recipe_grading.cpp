// The grading of a recipe: scalping by the formula of the curve, the diameters that are asked for, and the warning of
// too few grains.
#include <cmath>

#include "rvelab/pack/mass_curve.hpp"
#include "rvelab/pack/read_recipe.hpp"
#include "rvelab/pack/recipe_grading.hpp"
#include "rvelab/pack/scatter.hpp"
#include "tests/catch.hpp"
#include "tests/refusal.hpp"

using namespace rvelab;
using Catch::Matchers::Contains;

namespace {

/// A recipe of spheres, or of what the lines of [pack] say, with these lines of grains.
pack::RecipeFile graded_recipe(const std::string& grains, const std::string& head = "shape = \"sphere\"\nnumber = 500",
                               const std::vector<std::string>& assignments = {}) {
  return pack::parse_recipe("[pack]\nname = \"a\"\n" + head + "\n" +
                                (grains.starts_with("name") ? "[[grains]]\n" : "[grains]\n") + grains +
                                "\n[target]\npressure_Pa = 1e5\n[contact]\nlaw = \"linear\"\n[[material]]\n"
                                "name = \"sand\"\nyoung_modulus_Pa = 7e9\nfriction = 0.5\n",
                            "r.toml", assignments);
}

/// Straight on the semi-logarithmic sheet from 0.1 to 1.6 mm by mass: d60/d10 = 4.
const char* const wide_grading =
    "grading = \"linear\"\npassing_by = \"mass\"\nsmallest_radius_m = 0.05e-3\nlargest_radius_m = 0.8e-3\n";

}  // namespace

TEST_CASE("scalping cuts off the mass that the formula of the curve says, and leaves the rest of the curve") {
  const auto cut_of = [](const std::string& grains, const std::string& head) {
    const pack::Recipe recipe = graded_recipe(grains, head).recipe;
    return pack::scalped_mass(recipe.fractions[0], dimension_of(recipe.shape));
  };
  const std::string limits = "scalp_below_mm = 0.2\nscalp_above_mm = 0.8\n";
  for (const std::string head :
       {"shape = \"sphere\"\nnumber = 5000", "shape = \"disc\"\nnumber = 5000\nthickness_m = 1e-3"}) {
    CAPTURE(head);
    const int d = head.find("disc") == std::string::npos ? 3 : 2;
    // Straight over the logarithm, by mass: 0.1 to 1.6 mm are four doublings.
    CHECK(cut_of(wide_grading + limits, head).below == Approx(0.25).margin(1e-5));
    CHECK(cut_of(wide_grading + limits, head).above == Approx(0.25).margin(1e-5));
    // d10, d50 and d60 on one line of that kind.
    const std::string sieves = "grading = \"d10_d60\"\nd10_mm = 0.15\nd50_mm = 0.3968503\nd60_mm = 0.5061\n";
    const double doublings = std::log2(0.3968503 / 0.15) / 0.4;
    CHECK(cut_of(sieves + limits, head).below == Approx(0.1 + std::log2(0.2 / 0.15) / doublings).margin(1e-4));
    // By number, every radius equally frequent: mass below r goes with r^(d + 1).
    const std::string uniform = "smallest_radius_m = 0.05e-3\nlargest_radius_m = 0.5e-3\n" + limits;
    const auto power = [&](double r) { return std::pow(r, d + 1); };
    CHECK(cut_of(uniform, head).below == Approx((power(0.1) - power(0.05)) / (power(0.5) - power(0.05))));
    CHECK(cut_of(uniform, head).above == Approx((power(0.5) - power(0.4)) / (power(0.5) - power(0.05))));
    // A table by mass, straight over the radius.
    const std::string table =
        "grading = \"tabulated\"\npassing_by = \"mass\"\nradii_m = [0.05e-3, 0.3e-3, 0.5e-3]\npassing = [0, 0.6, 1]\n" +
        limits;
    CHECK(cut_of(table, head).below == Approx(0.6 * 0.05 / 0.25).margin(1e-5));
    CHECK(cut_of(table, head).above == Approx(0.4 * 0.1 / 0.2).margin(1e-5));
    // What is left of it, and the grains.
    const pack::Recipe recipe = graded_recipe(table, head).recipe;
    const pack::MassCurve curve(number_curve(recipe.fractions[0].grading, d), d);
    CHECK(curve.passing_at(0.3e-3) == Approx(0.48 / 0.68).margin(1e-5));
    CHECK(curve.passing_at(0.2e-3) == Approx(0.24 / 0.68).margin(1e-5));
    for (const double radius : pack::graded_grains(recipe).radius) CHECK((radius >= 0.1e-3 && radius <= 0.4e-3));
  }
  // One end alone, and none.
  const auto fine = cut_of(wide_grading + std::string("scalp_below_mm = 0.4\n"), "shape = \"sphere\"\nnumber = 500");
  CHECK(fine.below == Approx(0.5).margin(1e-5));
  CHECK(fine.above == 0);
  CHECK(cut_of(wide_grading, "shape = \"sphere\"\nnumber = 500").below == 0);
}

TEST_CASE("scalping that cuts off nothing or all is refused with the limits of the grading") {
  const auto refusal = [](const std::vector<std::string>& assignments) {
    return test::input_error([&] { graded_recipe(wide_grading, "shape = \"sphere\"\nnumber = 20000", assignments); });
  };
  CHECK(refusal({"grains.scalp_above_mm=0.5"}).empty());
  for (const char* key : {"grains.scalp_above_mm=1.6", "grains.scalp_above_mm=3", "grains.scalp_below_mm=0.1"})
    CHECK_THAT(refusal({key}), Contains("cuts off nothing") && Contains("0.1 to 1.6 mm; allowed: between the two"));
  for (const char* key : {"grains.scalp_above_mm=0.1", "grains.scalp_above_mm=0.05", "grains.scalp_below_mm=1.6"})
    CHECK_THAT(refusal({key}), Contains("leaves no grain") && Contains(std::string(key).substr(0, 21)));
  CHECK_THAT(refusal({"grains.scalp_above_mm=0.3", "grains.scalp_below_mm=0.4"}), Contains("leaves no grain"));
  CHECK_THAT(refusal({"grains.scalp_above_mm=-1"}), Contains("is out of range"));
  CHECK_THAT(refusal({"grains.scalp_above=0.5"}), Contains("grains.scalp_above_mm"));
  CHECK_THAT(refusal({"grains.sampling=layered"}), Contains("allowed: random, stratified"));
  // A cut in a gap of the grading is no cut of that end.
  CHECK_THAT(test::input_error([&] {
               graded_recipe(
                   "grading = \"tabulated\"\nradii_m = [1e-4, 2e-4, 4e-4, 5e-4]\npassing = [0, 0.5, 0.5, 1]\n"
                   "scalp_below_mm = 0.5\nscalp_above_mm = 0.7\n");
             }),
             Contains("leaves no grain"));
  // A curve too wide by its fine tail is one without it.
  const std::string tail = "grading = \"d10_d60\"\nd10_mm = 0.02\nd50_mm = 0.12\nd60_mm = 0.22\n";
  CHECK_THAT(test::input_error([&] { graded_recipe(tail); }),
             Contains("at most 100 times") && Contains("scalp_below_mm"));
  CHECK(test::input_error([&] { graded_recipe(tail + "scalp_below_mm = 0.05\n"); }).empty());
}

TEST_CASE("the diameters asked for are those of the curve, of several fractions those of their sum") {
  const pack::Recipe sand = graded_recipe(wide_grading).recipe;
  const double parts[] = {0.1, 0.5, 0.9};
  for (int k = 0; k < 3; ++k)
    CHECK(pack::asked_diameters(sand)[std::size_t(k)] == Approx(0.1e-3 * std::pow(16, parts[k])).epsilon(1e-4));
  // Scalped to 0.2 to 0.8 mm: two doublings.
  const pack::Recipe cut =
      graded_recipe(wide_grading + std::string("scalp_below_mm = 0.2\nscalp_above_mm = 0.8\n")).recipe;
  for (int k = 0; k < 3; ++k)
    CHECK(pack::asked_diameters(cut)[std::size_t(k)] == Approx(0.2e-3 * std::pow(4, parts[k])).epsilon(1e-4));
  // 40 % of the mass from 0.1 to 0.2 mm, 60 % from 0.4 to 0.8 mm, straight over the logarithm.
  const std::string curve = "grading = \"linear\"\npassing_by = \"mass\"\n";
  const pack::Recipe two = graded_recipe("name = \"fine\"\nshare = 0.4\n" + curve +
                                             "smallest_radius_m = 0.05e-3\nlargest_radius_m = 0.1e-3\n" +
                                             "[[grains]]\nname = \"coarse\"\nshare = 0.6\n" + curve +
                                             "smallest_radius_m = 0.2e-3\nlargest_radius_m = 0.4e-3\n",
                                         "shape = \"sphere\"\nnumber = 500\nshare_by = \"mass\"")
                               .recipe;
  const auto asked = pack::asked_diameters(two);
  CHECK(asked[0] == Approx(0.1e-3 * std::pow(2, 0.25)).epsilon(1e-4));
  CHECK(asked[1] == Approx(0.4e-3 * std::pow(2, 1.0 / 6)).epsilon(1e-4));
  CHECK(asked[2] == Approx(0.4e-3 * std::pow(2, 5.0 / 6)).epsilon(1e-4));
}

TEST_CASE("too few grains for a grading are reported with the numbers that mass and cell ask for, and a remedy") {
  const auto few = graded_recipe(wide_grading).doubts;
  REQUIRE(few.size() == 1);
  INFO(few[0]);
  // Of the drawn grains: the share of the largest.
  double mass = 0, largest = 0;
  for (const double radius : pack::graded_grains(graded_recipe(wide_grading).recipe).radius) {
    mass += std::pow(radius, 3);
    largest = std::max(largest, std::pow(radius, 3));
  }
  const auto number_after = [&](const std::string& words, std::size_t from = 0) {
    const auto at = few[0].find(words, from);
    REQUIRE(at != std::string::npos);
    return std::stod(few[0].substr(at + words.size()));
  };
  CHECK_THAT(few[0], Contains("pack.number = 500 is few for radii of 5e-05 to 0.0008 m (1 : 16)"));
  CHECK(number_after("the largest grain has ") == Approx(100 * largest / mass).margin(0.051));
  // Mean of r^3 of a straight line by mass: 3 ln R/(1 - R^-3) of the smallest. The largest has 5 % of N of them; three
  // of its diameters are the edge of a cube that holds N with a void ratio of 0.65.
  const double R = 16, mean = 3 * std::log(R) / (1 - std::pow(R, -3));
  const double by_share = std::pow(R, 3) / (0.05 * mean),
               by_width = std::pow(6 * R, 3) / (4.0 / 3 * 3.14159265358979 * mean * 1.65);
  CHECK(number_after("which takes ") == Approx(by_share).epsilon(1e-3));
  CHECK(number_after("which takes ", few[0].find("largest diameters wide")) == Approx(by_width).epsilon(1e-3));
  // As many are enough; and so are these, scalped as the message says.
  CHECK(graded_recipe(wide_grading, "shape = \"sphere\"\nnumber = " + std::to_string(long(1.01 * by_width)))
            .doubts.empty());
  CHECK(!graded_recipe(wide_grading, "shape = \"sphere\"\nnumber = " + std::to_string(long(0.5 * by_width)))
             .doubts.empty());
  const double above_mm = number_after("grains.scalp_above_mm = "), cut = number_after("cuts off ");
  const auto scalped = graded_recipe(wide_grading + ("scalp_above_mm = " + std::to_string(above_mm)));
  CHECK(scalped.doubts.empty());
  CHECK(100 * pack::scalped_mass(scalped.recipe.fractions[0], 3).above == Approx(cut).margin(0.051));
  CHECK(cut == Approx(100 * (1 - std::log2(above_mm / 0.1) / 4)).margin(0.06));
  // Usual ones, few of one size, and one stone in a sand.
  const std::string discs = "smallest_radius_m = 3e-3\nlargest_radius_m = 7e-3";
  CHECK(graded_recipe(discs, "number = 60").doubts.empty());
  REQUIRE(graded_recipe(discs, "number = 10").doubts.size() == 1);
  const auto equal = graded_recipe("smallest_radius_m = 3e-3\nlargest_radius_m = 3e-3", "number = 10").doubts;
  REQUIRE(equal.size() == 1);
  CHECK_THAT(equal[0], Contains("has 10 % of the mass; usual: up to 5 %, which takes 20 grains") && !Contains("scalp"));
  const auto stone = graded_recipe(
      "name = \"sand\"\nshare = 0.999\nsmallest_radius_m = 1e-3\nlargest_radius_m = 1e-3\n"
      "[[grains]]\nname = \"stone\"\nshare = 0.001\nsmallest_radius_m = 1e-2\n"
      "largest_radius_m = 1e-2",
      "number = 1000");
  REQUIRE(stone.doubts.size() == 1);
  CHECK_THAT(stone.doubts[0], Contains("the largest grain has 9.1 % of the mass"));
  // Millions are not drawn for it.
  CHECK(graded_recipe(wide_grading, "shape = \"sphere\"\nnumber = 100000000").doubts.empty());
}
