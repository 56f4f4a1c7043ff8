#include "rvelab/grains/grading.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
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

bool is_scalped(const Grading& grading) {
  return grading.scalp_below > 0 || grading.scalp_above < std::numeric_limits<double>::infinity();
}

struct Limits {
  double smallest, largest;  ///< radii, m
};

Limits limits_of(const Grading& grading) {
  if (grading.curve == GradingCurve::tabulated) return {grading.radii.front(), grading.radii.back()};
  return {grading.smallest_radius, grading.largest_radius};
}

/// Of a grading that is good otherwise; messages give diameters in mm, as the keys do.
void check_scalping(const Grading& grading, const std::string& of) {
  if (!is_scalped(grading)) return;
  const auto [smallest, largest] = limits_of(grading);
  const auto in_mm = [](double radius) { return in_words(2e3 * radius); };
  const auto expect = [&](bool allowed, const char* key, double value, const std::string& why) {
    if (allowed) return;
    throw InputError(of + key + " = " + in_mm(value) + " " + why + ": the diameters of the grading are " +
                     in_mm(smallest) + " to " + in_mm(largest) +
                     " mm; allowed: between the two, scalp_below_mm below scalp_above_mm; correct it or remove it");
  };
  const double below = grading.scalp_below, above = grading.scalp_above;
  expect(below == 0 || below > smallest, "scalp_below_mm", below, "cuts off nothing");
  expect(!std::isfinite(above) || above < largest, "scalp_above_mm", above, "cuts off nothing");
  expect(below < largest, "scalp_below_mm", below, "leaves no grain");
  const NumberCurve table{grading.radii, grading.passing};
  const bool leaves = above > smallest && above > below &&
                      (grading.curve != GradingCurve::tabulated || table.passing_at(above) > table.passing_at(below));
  expect(leaves, std::isfinite(above) ? "scalp_above_mm" : "scalp_below_mm", std::isfinite(above) ? above : below,
         "leaves no grain");
}

}  // namespace

double NumberCurve::radius_at(double part) const {
  const auto above = std::upper_bound(passing.begin(), passing.end(), part);
  if (above == passing.end()) return radii.back();
  const auto k = std::size_t(above - passing.begin());
  if (k == 0) return radii.front();
  return radii[k - 1] + (radii[k] - radii[k - 1]) * ((part - passing[k - 1]) / (passing[k] - passing[k - 1]));
}

double NumberCurve::passing_at(double radius) const {
  const auto above = std::upper_bound(radii.begin(), radii.end(), radius);
  if (above == radii.end()) return 1;
  const auto k = std::size_t(above - radii.begin());
  if (k == 0) return 0;
  return passing[k - 1] + (passing[k] - passing[k - 1]) * ((radius - radii[k - 1]) / (radii[k] - radii[k - 1]));
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
  if (grading.curve != GradingCurve::tabulated) {
    expect(grading.smallest_radius > 0 && grading.largest_radius >= grading.smallest_radius &&
               std::isfinite(grading.largest_radius),
           of + "smallest_radius_m = " + in_words(grading.smallest_radius) + " and " + of +
               "largest_radius_m = " + in_words(grading.largest_radius) +
               " are no limits of a grading; allowed: 0 < smallest <= largest; correct the radii");
    return check_scalping(grading, of);
  }
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
  check_scalping(grading, of);
}

Grading scalped(const Grading& grading) {
  if (!is_scalped(grading)) return grading;
  Grading rest = grading;
  rest.scalp_below = Grading{}.scalp_below;
  rest.scalp_above = Grading{}.scalp_above;
  const auto [smallest, largest] = limits_of(grading);
  rest.smallest_radius = std::max(smallest, grading.scalp_below);
  rest.largest_radius = std::min(largest, grading.scalp_above);
  if (grading.curve != GradingCurve::tabulated) return rest;
  const NumberCurve table{grading.radii, grading.passing};
  const double from = table.passing_at(rest.smallest_radius), to = table.passing_at(rest.largest_radius);
  rest.radii = {rest.smallest_radius};
  rest.passing = {0};
  for (std::size_t k = 0; k < table.radii.size(); ++k) {
    if (table.radii[k] <= rest.smallest_radius || table.radii[k] >= rest.largest_radius) continue;
    rest.radii.push_back(table.radii[k]);
    rest.passing.push_back((table.passing[k] - from) / (to - from));
  }
  rest.radii.push_back(rest.largest_radius);
  rest.passing.push_back(1);
  return rest;
}

NumberCurve number_curve(const Grading& grading, int dimension) {
  const NumberCurve given = as_given(scalped(grading));
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
  shuffle(radii, uniform);
  return radii;
}

void shuffle(std::vector<double>& radii, Uniform& uniform) {
  for (std::size_t k = radii.size(); k > 1; --k) std::swap(radii[k - 1], radii[std::size_t(uniform() * double(k))]);
}

}  // namespace rvelab
