// Grading curves: what passes a sieve, by number and by mass.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "rvelab/error.hpp"
#include "rvelab/grains/grading.hpp"
#include "tests/catch.hpp"
#include "tests/refusal.hpp"

using namespace rvelab;
using Catch::Matchers::Contains;

namespace {

Grading between(double smallest, double largest, GradingCurve curve, bool by_mass) {
  Grading grading;
  grading.curve = curve;
  grading.by_mass = by_mass;
  grading.smallest_radius = smallest;
  grading.largest_radius = largest;
  return grading;
}

/// Part of the mass (dimension 2 or 3) or of the number (0) of grains that are not larger than a radius.
double passing(const std::vector<double>& radii, double radius, int dimension) {
  double all = 0, below = 0;
  for (const double r : radii) {
    const double weight = std::pow(r, dimension);
    all += weight;
    if (r <= radius) below += weight;
  }
  return below / all;
}

}  // namespace

TEST_CASE("uniform: every radius is equally frequent, in every specimen as closely as its number allows") {
  const auto curve = number_curve(between(3e-3, 7e-3, GradingCurve::uniform, false), 2);
  CHECK(curve.radius_at(0) == 3e-3);
  CHECK(curve.radius_at(0.25) == Approx(4e-3));
  CHECK(curve.radius_at(1) == 7e-3);
  CHECK(curve.mean_power(2) == Approx((343e-9 - 27e-9) / 3 / 4e-3));  // mean of r^2
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Uniform uniform(seed);
    const auto radii = radii_of(curve, 400, uniform);
    for (double r = 3e-3; r <= 7e-3; r += 0.1e-3)
      CHECK(passing(radii, r, 0) == Approx((r - 3e-3) / 4e-3).margin(1.01 / 400));
    CHECK(!std::is_sorted(radii.begin(), radii.end()));
  }
}

TEST_CASE("linear by mass: straight on the semi-logarithmic sheet, and the number that belongs to it") {
  const double a = 1e-3, b = 10e-3;
  const auto by_number = number_curve(between(a, b, GradingCurve::linear, false), 3);
  CHECK(by_number.radius_at(0.5) == Approx(std::sqrt(a * b)).epsilon(1e-5));
  const auto curve = number_curve(between(a, b, GradingCurve::linear, true), 3);
  // Mass per ln r constant: number per r goes with r^-4.
  for (const double r : {1.1e-3, 1.5e-3, 2e-3, 4e-3, 8e-3}) {
    const double part = (std::pow(a, -3) - std::pow(r, -3)) / (std::pow(a, -3) - std::pow(b, -3));
    CHECK(curve.radius_at(part) == Approx(r).epsilon(2e-4));
  }
  Uniform uniform(3);
  const auto radii = radii_of(curve, 200000, uniform);
  for (const double r : {2e-3, 4e-3, 8e-3})
    CHECK(passing(radii, r, 3) == Approx(std::log(r / a) / std::log(b / a)).margin(0.01));
}

TEST_CASE("tabulated: a gap in the grading stays empty, by number and by mass") {
  Grading grading;
  grading.curve = GradingCurve::tabulated;
  grading.radii = {1e-3, 2e-3, 4e-3, 5e-3};
  grading.passing = {0, 0.5, 0.5, 1};
  for (const bool by_mass : {false, true}) {
    grading.by_mass = by_mass;
    Uniform uniform(7);
    const auto radii = radii_of(number_curve(grading, 2), 20000, uniform);
    CHECK(std::none_of(radii.begin(), radii.end(), [](double r) { return r > 2.001e-3 && r < 3.999e-3; }));
    CHECK(passing(radii, 3e-3, by_mass ? 2 : 0) == Approx(0.5).margin(0.002));
    CHECK(passing(radii, 1.5e-3, by_mass ? 2 : 0) == Approx(0.25).margin(0.002));
  }
}

TEST_CASE("one size is one size, whatever the curve") {
  for (const auto curve : {GradingCurve::uniform, GradingCurve::linear}) {
    Uniform uniform(1);
    for (const double r : radii_of(number_curve(between(2e-3, 2e-3, curve, true), 3), 50, uniform)) CHECK(r == 2e-3);
  }
}

TEST_CASE("what is no grading is refused with its name and what is allowed") {
  const auto message = [](const Grading& grading) {
    return test::input_error([&] { check_grading(grading, "grains.sand"); });
  };
  CHECK_THAT(message(between(2e-3, 1e-3, GradingCurve::uniform, false)),
             Contains("grains.sand.smallest_radius_m = 0.002"));
  CHECK_THAT(message(between(0, 1e-3, GradingCurve::linear, false)), Contains("allowed"));
  Grading table;
  table.curve = GradingCurve::tabulated;
  table.radii = {1e-3, 2e-3};
  table.passing = {0, 0.5, 1};
  CHECK_THAT(message(table), Contains("grains.sand.radii_m has 2 values, grains.sand.passing 3"));
  table.passing = {0.1, 1};
  CHECK_THAT(message(table), Contains("does not rise from 0 to 1"));
  table.passing = {0, 1};
  CHECK(message(table).empty());
  table.radii = {2e-3, 1e-3};
  CHECK_THAT(message(table), Contains("is not ascending"));
}

TEST_CASE("streams of one seed and seeds differ; the same ones are the same") {
  Uniform first(1), again(1), other_stream(1, 1), other_seed(2);
  int same_stream = 0, same_seed = 0;
  double sum = 0;
  for (int k = 0; k < 1000; ++k) {
    const double u = first();
    CHECK(u == again());
    same_stream += u == other_stream() ? 1 : 0;
    same_seed += u == other_seed() ? 1 : 0;
    CHECK((u >= 0 && u < 1));
    sum += u;
  }
  CHECK(same_stream + same_seed == 0);
  CHECK(sum / 1000 == Approx(0.5).margin(4 / std::sqrt(12e3)));
}
