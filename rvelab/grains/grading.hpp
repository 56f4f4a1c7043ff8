// Grading curves: which part of the grains, by number or by mass, is not larger than a radius; and grains that have
// such a curve.
//
// This file knows radii only: no position, no material. No function of libm stands in the way from a curve to a radius.
#pragma once

#include <limits>
#include <vector>

#include "rvelab/grains/uniform.hpp"

namespace rvelab {

enum class GradingCurve {
  uniform,   ///< straight over the radius: every radius between the limits equally frequent
  linear,    ///< straight over the logarithm of the radius, as on the usual semi-logarithmic sheet
  tabulated  ///< points, straight over the radius between them
};

/// A grading curve: passing(r), 0 at the smallest radius, 1 at the largest.
struct Grading {
  GradingCurve curve = GradingCurve::uniform;
  bool by_mass = false;                                  ///< the parts are of the mass; else of the number
  double smallest_radius = 3e-3, largest_radius = 7e-3;  ///< m; equal: one size. Tabulated: ends of `radii`
  std::vector<double> radii;                             ///< tabulated: m, ascending, at least two
  std::vector<double> passing;                           ///< tabulated: ascending, from 0 to 1
  /// Scalping: radii (m) below and above which grains are left out; the rest of the curve is the grading.
  double scalp_below = 0, scalp_above = std::numeric_limits<double>::infinity();
};

/// The curve by number, as a table: radii (m, ascending) and the part of the number that is not larger.
struct NumberCurve {
  std::vector<double> radii, passing;
  double radius_at(double part) const;     ///< m; part in [0, 1]
  double passing_at(double radius) const;  ///< radius in m; 0 below the curve, 1 above it
  double mean_power(int dimension) const;  ///< mean of r^dimension over the number, m^dimension
};

/// Throws InputError naming what is wrong: limits not positive or not ascending, table too short, passing not from 0
/// to 1, scalping that cuts off nothing or all. `where` stands before each name in the message.
void check_grading(const Grading& grading, const char* where);

/// What scalping leaves of a grading, as a grading without it: passing(r) - passing(scalp_below), over the same of
/// scalp_above. Without scalping the grading itself.
Grading scalped(const Grading& grading);

/// The curve by number, after scalping. A mass is taken as r^dimension: 2 for discs, 3 for spheres.
NumberCurve number_curve(const Grading& grading, int dimension);

/// Radii of `count` grains, m: one from each of `count` equal parts of the number, in random order. So the grains have
/// the curve as closely as their number allows, in every specimen.
std::vector<double> radii_of(const NumberCurve& curve, std::size_t count, Uniform& uniform);

/// Every order equally likely.
void shuffle(std::vector<double>& radii, Uniform& uniform);

}  // namespace rvelab
