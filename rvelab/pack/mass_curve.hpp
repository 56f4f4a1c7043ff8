// The mass that belongs to a grading curve by number, and the diameters by mass of grains that were drawn from one.
#pragma once

#include <utility>
#include <vector>

#include "rvelab/grains/grading.hpp"

namespace rvelab::pack {

/// Parts of the mass at which a grading and the grains drawn from it are compared: d10, d50, d90.
inline constexpr double compared_parts[] = {0.1, 0.5, 0.9};

/// The curve by mass of grains whose mass grows with r^dimension:
///   passing by mass(r) = (integral of r^dimension over the number up to r) / (the same over all).
class MassCurve {
 public:
  MassCurve(NumberCurve by_number, int dimension);
  const NumberCurve& by_number() const { return by_number_; }
  int dimension() const { return dimension_; }
  double mean_power() const { return power_.back(); }  ///< mean of r^dimension over the number, m^dimension
  /// Part of the mass in the finest part `number` of the grains, and its inverse; all in [0, 1].
  double mass_at(double number) const;
  double number_at(double mass) const;
  double passing_at(double radius) const { return mass_at(by_number_.passing_at(radius)); }  ///< by mass; radius in m
  double radius_at(double mass) const { return by_number_.radius_at(number_at(mass)); }      ///< m

 private:
  /// Integral of r^dimension over the number, m^dimension, from knot k up to `number`.
  double power_from(std::size_t k, double number) const;
  std::size_t knot_below(const std::vector<double>& values, double value) const;

  NumberCurve by_number_;
  int dimension_;
  std::vector<double> power_;  ///< integral of r^dimension over the number up to each knot
};

/// r^2 or r^3.
double power_of(double radius, int dimension);
/// The radius of a power; 0 of what is no positive number.
double root_of(double power, int dimension);

/// A positive number with three digits, rounded down.
double in_three_digits_down(double value);

/// Of grains of given radii and masses: the smallest radius at and below which at least each of the parts of the mass
/// lies.
std::vector<double> radii_passing(std::vector<std::pair<double, double>> grains, const std::vector<double>& parts);

}  // namespace rvelab::pack
