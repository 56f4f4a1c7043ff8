// Gradings by d10, d50 and d60: the curve passes through them, and a sample of grains has them.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "rvelab/grains/sieve_grading.hpp"
#include "tests/catch.hpp"

using namespace rvelab;
using Catch::Matchers::Contains;

namespace {

/// The diameter that a part of the mass of the grains passes.
double diameter_at(std::vector<double> radii, double part, int dimension) {
  std::sort(radii.begin(), radii.end());
  double whole = 0, sum = 0;
  for (const double radius : radii) whole += std::pow(radius, dimension);
  for (const double radius : radii)
    if ((sum += std::pow(radius, dimension)) >= part * whole) return 2 * radius;
  return 2 * radii.back();
}

}  // namespace

TEST_CASE("Grains drawn from d10, d50 and d60 have these by mass") {
  const double d10 = 0.11e-3, d50 = 0.17e-3, d60 = 0.187e-3;
  for (const int dimension : {2, 3}) {
    const Grading grading = sieve_grading(d10, d50, d60);
    check_grading(grading, "grains");
    Uniform uniform(1);
    const auto radii = radii_of(number_curve(grading, dimension), 20000, uniform);
    CHECK(diameter_at(radii, 0.1, dimension) == Approx(d10).epsilon(0.005));
    CHECK(diameter_at(radii, 0.5, dimension) == Approx(d50).epsilon(0.005));
    CHECK(diameter_at(radii, 0.6, dimension) == Approx(d60).epsilon(0.005));
  }
}

TEST_CASE("A grading whose d50 lies on the straight line is straight over the logarithm to both ends") {
  // d = d10 (d60/d10)^((p - 0.1)/0.5)
  const double d10 = 1e-3, d60 = 2e-3, d50 = d10 * std::pow(2, 0.8);
  const Grading grading = sieve_grading(d10, d50, d60);
  for (std::size_t k = 0; k < grading.radii.size(); ++k)
    CHECK(2 * grading.radii[k] == Approx(d10 * std::pow(2, (grading.passing[k] - 0.1) / 0.5)));
  CHECK(grading.passing.front() == 0);
  CHECK(grading.passing.back() == 1);
}

TEST_CASE("Three equal diameters are grains of one size, and diameters that make no curve are refused") {
  CHECK(sieve_grading(3e-3, 3e-3, 3e-3).largest_radius == 1.5e-3);
  CHECK(sieve_grading(3e-3, 3e-3, 3e-3).smallest_radius == 1.5e-3);
  CHECK(wrong_with_sieves(3e-3, 3e-3, 3e-3).empty());
  CHECK(wrong_with_sieves(0.11e-3, 0.17e-3, 0.187e-3).empty());
  CHECK_THAT(wrong_with_sieves(2e-3, 1e-3, 3e-3), Contains("d10 < d50 < d60"));
  CHECK_THAT(wrong_with_sieves(1e-3, 3e-3, 3e-3), Contains("d10 < d50 < d60"));
  CHECK_THAT(wrong_with_sieves(1e-3, 1.1e-3, 4e-3), Contains("factor of 1.5"));
  CHECK_THAT(wrong_with_sieves(0.1e-3, 1e-3, 1.8e-3), Contains("100 times"));
}
