// Stratified sampling: d10, d50 and d90 by mass of few grains of a wide grading, exact shares of the mass, and what
// no number of grains can do.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "rvelab/pack/draw.hpp"
#include "rvelab/pack/largest_grain.hpp"
#include "rvelab/pack/read_recipe.hpp"
#include "rvelab/pack/sampling.hpp"
#include "rvelab/pack/scatter.hpp"
#include "rvelab/pack/search.hpp"
#include "tests/catch.hpp"
#include "tests/pack/recipes.hpp"
#include "tests/refusal.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

/// Straight by mass on the semi-logarithmic sheet: d(p) = d(0) (d60/d10)^(2 p).
pack::Recipe straight(int dimension, double uniformity, std::size_t number) {
  pack::Recipe recipe = dimension == 2 ? discs(number) : spheres(number);
  Grading& grading = recipe.fractions[0].grading;
  grading.curve = GradingCurve::linear;
  grading.by_mass = true;
  grading.smallest_radius = 1e-3;
  grading.largest_radius = 1e-3 * uniformity * uniformity;
  recipe.fractions[0].sampling = pack::Sampling::stratified;
  return recipe;
}

/// Radius that a part of the mass of grains is not larger than.
double radius_passing(std::vector<std::pair<double, double>> grains, double part) {
  std::sort(grains.begin(), grains.end());
  double all = 0, passed = 0;
  for (const auto& [radius, mass] : grains) all += mass;
  for (const auto& [radius, mass] : grains) {
    passed += mass;
    if (passed >= part * all) return radius;
  }
  return grains.back().first;
}

/// The grains of a recipe of one material: radius, and mass in some unit.
std::vector<std::pair<double, double>> drawn_grains(const pack::Recipe& recipe) {
  std::vector<std::pair<double, double>> grains;
  for (const double radius : pack::graded_grains(recipe).radius)
    grains.emplace_back(radius, std::pow(radius, dimension_of(recipe.shape)));
  return grains;
}

void check_straight(const std::vector<std::pair<double, double>>& grains, double uniformity) {
  for (const double part : {0.1, 0.5, 0.9}) {
    CAPTURE(part);
    CHECK(radius_passing(grains, part) == Approx(1e-3 * std::pow(uniformity, 2 * part)).epsilon(0.03));
  }
}

}  // namespace

TEST_CASE("d10, d50 and d90 by mass of stratified grains are those of the grading, from narrow to wide") {
  for (const int dimension : {2, 3})
    for (const double uniformity : {1.3, 4.0, 10.0})
      for (const std::size_t number : {std::size_t{500}, std::size_t{2000}}) {
        CAPTURE(dimension, uniformity, number);
        // Fewer than these have no such d10 and d90: below.
        if (uniformity == 10 && (dimension == 3 || number == 500)) continue;
        const auto grains = drawn_grains(straight(dimension, uniformity, number));
        CHECK(grains.size() == number);
        check_straight(grains, uniformity);
        for (const auto& [radius, mass] : grains) {
          CHECK(radius >= 1e-3 * (1 - 1e-9));
          CHECK(radius <= 1e-3 * uniformity * uniformity * (1 + 1e-9));
        }
      }
  // Tens of grains of a sand.
  for (const std::size_t number : {std::size_t{10}, std::size_t{30}})
    check_straight(drawn_grains(straight(3, 1.3, number)), 1.3);
}

TEST_CASE("too few grains for d10 and d90 are refused with how many it takes, or which scalping") {
  for (const auto& [dimension, number] :
       {std::pair(2, std::size_t{100}), {3, std::size_t{500}}, {3, std::size_t{2000}}}) {
    CAPTURE(dimension, number);
    const double uniformity = 10;
    pack::Recipe recipe = straight(dimension, uniformity, number);
    const std::string message = input_error([&] { pack::graded_grains(recipe); });
    INFO(message);
    CHECK_THAT(message, Contains("grains.sampling = \"stratified\"") && Contains(std::to_string(number) + " grains"));
    const auto value_after = [&](const std::string& key) {
      const auto at = message.find(key + " = ");
      REQUIRE(at != std::string::npos);
      return std::stod(message.substr(at + key.size() + 3));
    };
    const double takes = value_after("pack.number"), below_mm = value_after("grains.scalp_below_mm");
    // Of any grains with these two diameters, those of d90 and more have at most half of the mass (d50 is below), and
    // those up to d10 a tenth of it at least: N >= 0.1 M/m(d10), M >= 2 m(d90).
    const double ratio = std::pow(uniformity, 1.6) * 0.97 / 1.03;
    CHECK(takes >= 0.2 * std::pow(ratio, dimension));
    CHECK(takes < 20 * std::pow(ratio, dimension));
    recipe.fractions[0].grading.scalp_below = 5e-4 * below_mm;
    CHECK(drawn_grains(recipe).size() == number);
    recipe = straight(dimension, uniformity, std::size_t(takes));
    check_straight(drawn_grains(recipe), uniformity);
  }
}

TEST_CASE("strata keep the mass of the curve: the mean of r^3 and the passing are those of the formula") {
  // By number, every radius equally frequent: mass below r goes with r^4 - a^4.
  pack::Recipe recipe = spheres(400);
  recipe.fractions[0].sampling = pack::Sampling::stratified;
  const double a = 1e-3, b = 2e-3;
  const auto grains = drawn_grains(recipe);
  double mass = 0, below = 0;
  for (const auto& [radius, each] : grains) {
    mass += each;
    if (radius < 1.5e-3) below += each;
  }
  CHECK(mass / 400 == Approx((std::pow(b, 4) - std::pow(a, 4)) / (4 * (b - a))).epsilon(1e-12));
  CHECK(below / mass ==
        Approx((std::pow(1.5e-3, 4) - std::pow(a, 4)) / (std::pow(b, 4) - std::pow(a, 4))).epsilon(1e-12));
  const double d50 = std::pow(0.5 * (std::pow(a, 4) + std::pow(b, 4)), 0.25);
  CHECK(radius_passing(grains, 0.5) == Approx(d50).epsilon(2e-3));
  const pack::MassCurve curve(number_curve(recipe.fractions[0].grading, 3), 3);
  CHECK(curve.radius_at(0.5) == Approx(d50).epsilon(1e-12));
  CHECK(curve.passing_at(d50) == Approx(0.5).epsilon(1e-12));
}

TEST_CASE("fractions by mass have exactly their shares, each with its own d10, d50 and d90") {
  pack::Recipe recipe = straight(3, 1.5, 1500);
  recipe.share_by_mass = true;
  recipe.materials.push_back(recipe.materials[0]);
  recipe.materials[1].density = 4000;
  recipe.fractions.push_back(recipe.fractions[0]);
  recipe.fractions[0].name = "fine";
  recipe.fractions[1].name = "coarse";
  recipe.fractions[0].share = 0.7;
  recipe.fractions[1].share = 0.3;
  recipe.fractions[1].material = 1;
  recipe.fractions[1].grading.smallest_radius = 3e-3;
  recipe.fractions[1].grading.largest_radius = 6e-3;
  const Grains grains = pack::graded_grains(recipe);
  double mass[2] = {0, 0};
  std::vector<std::pair<double, double>> of_fraction[2];
  for (std::size_t g = 0; g < grains.size(); ++g) {
    const auto f = std::size_t(grains.material[g]);
    const double each = recipe.materials[f].density * std::pow(grains.radius[g], 3);
    mass[f] += each;
    of_fraction[f].emplace_back(grains.radius[g], each);
  }
  CHECK(mass[0] / (mass[0] + mass[1]) == Approx(0.7).epsilon(1e-12));
  CHECK(mass[1] / (mass[0] + mass[1]) == Approx(0.3).epsilon(1e-12));
  check_straight(of_fraction[0], 1.5);
  for (const double part : {0.1, 0.5, 0.9})
    CHECK(radius_passing(of_fraction[1], part) == Approx(3e-3 * std::pow(2, part)).epsilon(0.03));
}

TEST_CASE("a grading with a gap at d50, and one size, can be stratified") {
  pack::Recipe recipe = spheres(300);
  Grading& grading = recipe.fractions[0].grading;
  recipe.fractions[0].sampling = pack::Sampling::stratified;
  grading.curve = GradingCurve::tabulated;
  grading.by_mass = true;
  grading.radii = {1e-3, 1.2e-3, 2e-3, 2.4e-3};
  grading.passing = {0, 0.4, 0.4, 1};
  const auto grains = drawn_grains(recipe);
  CHECK(radius_passing(grains, 0.1) == Approx(1.05e-3).epsilon(0.03));
  CHECK(radius_passing(grains, 0.5) == Approx(2e-3 + 0.4e-3 / 6).epsilon(0.03));
  CHECK(radius_passing(grains, 0.9) == Approx(2e-3 + 0.4e-3 * 5 / 6).epsilon(0.03));
  for (const auto& [radius, mass] : grains) CHECK((radius < 1.21e-3 || radius > 1.99e-3));
  recipe = spheres(50);
  recipe.fractions[0].sampling = pack::Sampling::stratified;
  recipe.fractions[0].grading.smallest_radius = recipe.fractions[0].grading.largest_radius;
  for (const double radius : pack::graded_grains(recipe).radius) CHECK(radius == 2e-3);
}

TEST_CASE("a grading whose masses no double holds is refused") {
  for (const auto& [smallest, largest] : {std::pair(1e-300, 1e-200), {1e150, 1e200}}) {
    pack::Recipe recipe = straight(3, 2, 100);
    recipe.fractions[0].grading.smallest_radius = smallest;
    recipe.fractions[0].grading.largest_radius = largest;
    CHECK_THAT(input_error([&] { pack::graded_grains(recipe); }), Contains("more than a million grains"));
  }
}

TEST_CASE("stratified sizes are the same for every seed, in another order; a specimen on any number of threads too") {
  pack::Recipe recipe = straight(2, 1.5, 80);
  std::vector<double> first = pack::graded_grains(recipe).radius;
  recipe.seed = 2;
  std::vector<double> second = pack::graded_grains(recipe).radius;
  CHECK(first != second);
  std::sort(first.begin(), first.end());
  std::sort(second.begin(), second.end());
  CHECK(first == second);
  recipe.void_ratio = 0.2;
  recipe.void_ratio_tolerance = 4e-3;
  Workers one(1), three(3);
  CHECK(Rve(pack::pack(recipe, one).specimen).save() == Rve(pack::pack(recipe, three).specimen).save());
}

TEST_CASE("grains of every shape have the grading by mass: ellipses, clumps and superellipsoids") {
  std::vector<pack::Recipe> recipes{ellipses(60), spheres(60), spheres(60), discs(60)};
  recipes[1].clumps = true;
  recipes[1].fractions[0].clump = published_clump("tetrapod", 3);
  recipes[2].shape = Shape::superellipsoid;
  recipes[2].fractions[0].half_axes = {1.3, 1, 0.8};
  for (pack::Recipe& recipe : recipes) {
    CAPTURE(int(recipe.shape), recipe.clumps);
    Grading& grading = recipe.fractions[0].grading;
    grading.curve = GradingCurve::linear;
    grading.by_mass = true;
    grading.smallest_radius = 1e-3;
    grading.largest_radius = 1e-3 * 1.5 * 1.5;
    recipe.fractions[0].sampling = pack::Sampling::stratified;
    const Specimen specimen = pack::draw(recipe, 1, 0.1, nullptr).specimen;
    const auto grains = pack::radii_and_masses(specimen);
    CHECK(grains.size() == recipe.number);
    check_straight(grains, 1.5);
    const pack::LargestGrain largest = pack::largest_grain(specimen);
    double mass = 0;
    const Network network = Rve(specimen).network();
    for (std::size_t g = 0; g < grains.size(); ++g) {
      CHECK(grains[g].second == Approx(network.grains[g].mass));
      CHECK(grains[g].first == Approx(network.grains[g].radius));
      mass += grains[g].second;
    }
    const auto top = std::max_element(grains.begin(), grains.end());
    CHECK(largest.mass_share == Approx(top->second / mass));
    CHECK(largest.number_by_share == Approx(double(grains.size()) * largest.mass_share / 0.05));
  }
}
