// The way of an increment: which part of F = R U is done at a fraction of it, and the increments between such parts.
#pragma once

#include "rvelab/cell/cell.hpp"

namespace rvelab {

/// Rotation matrix of a rotation vector (rad), by series: no libm in what touches state.
Matrix3 rotation_matrix(const Vector3& rotation_vector);
/// Rotation vector (rad) of a proper rotation matrix, with square roots only.
Vector3 rotation_vector(const Matrix3& rotation);

/// The part of an increment done at fraction s, in the frame of its start (where quarter turns change no bit of it):
/// straight in the stretch, geodesic in the rotation. Quasi-static (not `turning`) the frame turns at the end, since
/// nothing depends on when.
class StrainPath {
 public:
  StrainPath(const FrameSplit& increment, bool turning);
  Matrix3 at(double fraction) const;
  /// Norm of the Green-Lagrange strain (U^T U - I)/2 of the whole: independent of the frame, which |U - I| of a
  /// triangular U is not.
  double strain() const;

  FrameSplit whole;

 private:
  Vector3 turn_;
  bool turns_;
};

/// How the frame has turned since it was `start_frame`; orthogonal to round-off, so that no error of Q feeds on itself.
Matrix3 turned_since(const Matrix3& start_frame, const Cell& cell);

/// From the part `done` of an increment to the part `next`, for the cell as it is now.
FrameSplit next_part(const Matrix3& start_frame, const Cell& cell, const Matrix3& done, const Matrix3& next);

}  // namespace rvelab
