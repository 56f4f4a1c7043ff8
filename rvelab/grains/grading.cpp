#include "rvelab/grains/grading.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "rvelab/error.hpp"

namespace rvelab {

namespace {

/// Pieces that a part of a curve is cut into where its number is not straight over the radius.
constexpr int pieces = 512;

double power(double radius, int dimension) { return dimension == 2 ? radius * radius : radius * radius * radius; }

/// ratio^(k/pieces), k = 0 .. pieces, by square roots.
std::vector<double> powers_of(double ratio) {
  std::vector<double> powers(pieces + 1, 1.0);
  double root = ratio;
  for (int step = pieces / 2; step >= 1; step /= 2) {
    root = std::sqrt(root);
    for (int k = step; k < pieces; k += 2 * step) powers[std::size_t(k)] = powers[std::size_t(k - step)] * root;
  }
  powers[pieces] = ratio;
  return powers;
}

/// The curve as it is given, by number or by mass.
NumberCurve as_given(const Grading& grading) {
  if (grading.curve == GradingCurve::tabulated) return {grading.radii, grading.passing};
  if (grading.curve == GradingCurve::uniform || grading.smallest_radius == grading.largest_radius)
    return {{grading.smallest_radius, grading.largest_radius}, {0, 1}};
  NumberCurve curve;
  const auto powers = powers_of(grading.largest_radius / grading.smallest_radius);
  for (int k = 0; k <= pieces; ++k) {
    curve.radii.push_back(grading.smallest_radius * powers[std::size_t(k)]);
    curve.passing.push_back(double(k) / pieces);
  }
  curve.radii.back() = grading.largest_radius;
  return curve;
}

}  // namespace

double NumberCurve::radius_at(double part) const {
  const auto above = std::upper_bound(passing.begin(), passing.end(), part);
  if (above == passing.end()) return radii.back();
  const auto k = std::size_t(above - passing.begin());
  if (k == 0) return radii.front();
  return radii[k - 1] + (radii[k] - radii[k - 1]) * ((part - passing[k - 1]) / (passing[k] - passing[k - 1]));
}

double NumberCurve::mean_power(int dimension) const {
  double sum = 0;
  for (std::size_t k = 1; k < radii.size(); ++k) {
    // Simpson's rule: exact for powers up to three over a straight part.
    const double a = radii[k - 1], b = radii[k];
    const double mean = (power(a, dimension) + 4 * power(0.5 * (a + b), dimension) + power(b, dimension)) / 6;
    sum += (passing[k] - passing[k - 1]) * mean;
  }
  return sum;
}

void check_grading(const Grading& grading, const char* where) {
  const std::string of = where + std::string(".");
  const auto expect = [](bool allowed, const std::string& text) {
    if (!allowed) throw InputError(text);
  };
  if (grading.curve != GradingCurve::tabulated)
    return expect(grading.smallest_radius > 0 && grading.largest_radius >= grading.smallest_radius &&
                      std::isfinite(grading.largest_radius),
                  of + "smallest_radius_m = " + in_words(grading.smallest_radius) + " and " + of +
                      "largest_radius_m = " + in_words(grading.largest_radius) +
                      " are no limits of a grading; allowed: 0 < smallest <= largest; correct the radii");
  const auto& radii = grading.radii;
  const auto& passing = grading.passing;
  expect(radii.size() >= 2 && passing.size() == radii.size(),
         of + "radii_m has " + std::to_string(radii.size()) + " values, " + of + "passing " +
             std::to_string(passing.size()) + "; allowed: as many in both, at least two; correct the lists");
  const auto falls = [](double a, double b) { return !(a < b); };
  expect(radii.front() > 0 && std::adjacent_find(radii.begin(), radii.end(), falls) == radii.end(),
         of + "radii_m is not ascending from above 0; allowed: each larger than the one before; correct it");
  expect(passing.front() == 0 && passing.back() == 1 && std::is_sorted(passing.begin(), passing.end()),
         of + "passing does not rise from 0 to 1; allowed: 0 first, 1 last, none below the one before; correct it");
}

NumberCurve number_curve(const Grading& grading, int dimension) {
  const NumberCurve given = as_given(grading);
  if (!grading.by_mass) return given;
  // The number of a small piece of the mass is that mass over the mass of one grain.
  NumberCurve curve;
  double number = 0;
  curve.radii.push_back(given.radii.front());
  curve.passing.push_back(0);
  for (std::size_t part = 1; part < given.radii.size(); ++part) {
    const double a = given.radii[part - 1], b = given.radii[part];
    const double mass = given.passing[part] - given.passing[part - 1];
    const int cuts = given.radii.size() > 100 ? 4 : pieces;
    for (int k = 0; k < cuts; ++k) {
      const double middle = a + (b - a) * ((k + 0.5) / cuts);
      number += mass / cuts / power(middle, dimension);
      curve.radii.push_back(k + 1 == cuts ? b : a + (b - a) * (double(k + 1) / cuts));
      curve.passing.push_back(number);
    }
  }
  for (double& passing : curve.passing) passing /= number;
  curve.passing.back() = 1;
  return curve;
}

std::vector<double> radii_of(const NumberCurve& curve, std::size_t count, Uniform& uniform) {
  std::vector<double> radii(count);
  for (std::size_t k = 0; k < count; ++k) radii[k] = curve.radius_at((double(k) + uniform()) / double(count));
  for (std::size_t k = count; k > 1; --k) std::swap(radii[k - 1], radii[std::size_t(uniform() * double(k))]);
  return radii;
}

}  // namespace rvelab
