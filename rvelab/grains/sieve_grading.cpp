#include "rvelab/grains/sieve_grading.hpp"

#include <algorithm>
#include <cmath>

#include "rvelab/error.hpp"

namespace rvelab {
namespace {

/// Ratio of the diameters at both ends of a tenth of the mass, of which there are five from d10 to d60:
/// (d60/d10)^(1/5), by Newton's method.
double ratio_per_tenth(double a) {
  double x = a > 1 ? a : 1;
  for (int round = 0; round < 200; ++round) x = (4 * x + a / (x * x * x * x)) / 5;
  return x;
}

double fourth_root(double a) { return std::sqrt(std::sqrt(a)); }

struct Ends {
  double smallest, largest;
};

/// Diameters at 0 and at 100 %.
Ends ends_of(double d10, double d50, double d60) {
  const double root = ratio_per_tenth(d60 / d10);
  return {d10 / fourth_root(d50 / d10), d60 * root * root * root * root};
}

/// Adds points between two of the curve, evenly in the logarithm of the radius.
void add_part(Grading& grading, double from, double to, double passing_from, double passing_to) {
  constexpr int pieces = 32;
  double ratio = to / from;
  for (int step = pieces; step > 1; step /= 2) ratio = std::sqrt(ratio);
  double radius = from;
  for (int k = 1; k <= pieces; ++k) {
    radius = k == pieces ? to : radius * ratio;
    grading.radii.push_back(radius);
    grading.passing.push_back(passing_from + (passing_to - passing_from) * k / pieces);
  }
}

}  // namespace

Grading sieve_grading(double d10, double d50, double d60) {
  Grading grading;
  grading.by_mass = true;
  if (d10 == d60) {
    grading.curve = GradingCurve::uniform;
    grading.smallest_radius = grading.largest_radius = 0.5 * d50;
    return grading;
  }
  const Ends ends = ends_of(d10, d50, d60);
  grading.curve = GradingCurve::tabulated;
  grading.radii = {0.5 * ends.smallest};
  grading.passing = {0};
  add_part(grading, 0.5 * ends.smallest, 0.5 * d10, 0, 0.1);
  add_part(grading, 0.5 * d10, 0.5 * d50, 0.1, 0.5);
  add_part(grading, 0.5 * d50, 0.5 * d60, 0.5, 0.6);
  add_part(grading, 0.5 * d60, 0.5 * ends.largest, 0.6, 1);
  grading.passing.back() = 1;
  grading.smallest_radius = grading.radii.front();
  grading.largest_radius = grading.radii.back();
  return grading;
}

std::string wrong_with_sieves(double d10, double d50, double d60, double scalp_below, double scalp_above) {
  if (d10 == d50 && d50 == d60) return "";
  if (!(d10 < d50 && d50 < d60))
    return "does not lie between d10 and d60; allowed: d10 < d50 < d60, or all three equal; correct the sieve curve";
  const double root = ratio_per_tenth(d60 / d10), straight = d60 / root;
  constexpr double most = 1.5;
  if (d50 > most * straight || straight > most * d50)
    return "lies off the curve from d10 to d60, whose d50 is about " + in_words(1e3 * straight) +
           " mm; allowed: within a factor of 1.5 of it; correct the sieve curve, or give all of it (grading = "
           "\"tabulated\")";
  Ends ends = ends_of(d10, d50, d60);
  ends = {std::max(ends.smallest, scalp_below), std::min(ends.largest, scalp_above)};
  if (ends.largest > 100 * ends.smallest)
    return "gives grains from " + in_words(1e3 * ends.smallest) + " to " + in_words(1e3 * ends.largest) +
           " mm; allowed: a largest grain of at most 100 times the smallest; cut the fine tail (scalp_below_mm)";
  return "";
}

}  // namespace rvelab
