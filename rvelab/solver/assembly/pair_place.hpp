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

/// The same of a pair of ellipses, whose normal is not along the branch. Of a pair that is apart, `overlap` is < 0 and
/// no further from 0 than the distance, and the normal is a direction that shows it.
struct EllipsePlace {
  Branch branch;
  double length, overlap;
  Branch normal;            ///< of length 1
  double reach_i, reach_j;  ///< m, from the centres to the tangents
  double turn_i, turn_j;    ///< m, torque of a force of 1 along n on either grain (kernels/ellipses.hpp)

  const Branch& along() const { return normal; }
  double along_length() const { return 1; }
  /// R*/r* of Hertz's radius from curvature, for grains of r = sqrt(a b), m.
  double hertz_radius_ratio(double radius_i, double radius_j) const {
    return rvelab::hertz_radius_ratio(radius_i, reach_i, radius_j, reach_j);
  }
  /// Rate at which spins (rad/s) open the contact, m/s.
  double opening_by(double spin_i, double spin_j) const { return spin_i * turn_i + spin_j * turn_j; }
};

/// From the branch (m) and the rows of the two grains (kernels/configuration.hpp): what the step kernels find, bit for
/// bit.
EllipsePlace place_of_ellipses(const Branch& branch, const double* row_i, const double* row_j);
/// Of a pair that is apart (overlap < 0): by the direction of the distance, not just one that shows it.
EllipsePlace nearest_place_of_ellipses(const EllipsePlace& apart, const double* row_i, const double* row_j);

/// An ellipse by its semi-axes (m) and the unit vector along the long one.
struct EllipseForm {
  double semi_major, semi_minor, axis_x, axis_y;
};
EllipsePlace place_of_ellipses(const Branch& branch, const EllipseForm& i, const EllipseForm& j);

}  // namespace rvelab
