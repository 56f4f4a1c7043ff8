// Where a listed pair lies: branch, overlap, normal, arms. What sums over pairs ask of every shape.
#pragma once

#include <cmath>

#include "rvelab/contact/hertz_curvature.hpp"

namespace rvelab {

/// Branch of a listed pair, m, cell frame.
struct Branch {
  double x, y, z;
  double length() const { return std::sqrt(x * x + y * y + z * z); }
};

/// A listed pair of round grains as they lie now; m, cell frame.
struct PairPlace {
  Branch branch;
  double length, overlap;

  /// A vector along the normal from i to j, and its length: no division where none is needed.
  const Branch& along() const { return branch; }
  double along_length() const { return length; }
};

/// The same of a pair of grains that are not round, whose normal is not along the branch. Of a pair that is apart,
/// `overlap` is < 0 and no further from 0 than the distance, and the normal is a direction that shows it.
struct OutlinePlace {
  Branch branch;
  double length, overlap;
  Branch normal;            ///< of length 1
  double reach_i, reach_j;  ///< m, from the centres to the tangents
  double turn_i, turn_j;    ///< m, torque of a force of 1 along n on either grain

  const Branch& along() const { return normal; }
  double along_length() const { return 1; }
  /// R*/r* of Hertz's radius from curvature, for grains of these radii, m.
  double hertz_radius_ratio(double radius_i, double radius_j) const {
    return rvelab::hertz_radius_ratio(radius_i, reach_i, radius_j, reach_j);
  }
  /// Rate at which spins (rad/s) open the contact, m/s.
  double opening_by(double spin_i, double spin_j) const { return spin_i * turn_i + spin_j * turn_j; }
};

/// The same of a pair of superellipsoids. Of a pair that is apart normal and point are those that show it.
struct SolidPlace {
  Branch branch;
  double length, overlap;
  Branch normal;            ///< of length 1
  Branch point;             ///< m, contact point from the centre of i
  double hertz_radius = 0;  ///< R*, m, where Hertz's radius is that of the curvature and the pair touches

  const Branch& along() const { return normal; }
  double along_length() const { return 1; }
  /// From the centre of j.
  Branch point_j() const { return {point.x - branch.x, point.y - branch.y, point.z - branch.z}; }
  /// Rate at which spins (rad/s, three each) open the contact, m/s: n.(w_j x x_j - w_i x x_i).
  double opening_by(const double* spin_i, const double* spin_j) const {
    const auto by = [this](const double* w, const Branch& x) {
      return normal.x * (w[1] * x.z - w[2] * x.y) + normal.y * (w[2] * x.x - w[0] * x.z) +
             normal.z * (w[0] * x.y - w[1] * x.x);
    };
    return by(spin_j, point_j()) - by(spin_i, point);
  }
};

}  // namespace rvelab
