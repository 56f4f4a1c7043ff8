#include "rvelab/solver/loading/strain_path.hpp"

#include <Eigen/LU>

#include "rvelab/solver/loading/stepping.hpp"

namespace rvelab {

Matrix3 rotation_matrix(const Vector3& vector) {
  // exp by halving six times, a short series, and squaring back.
  const Vector3 w = vector / 64;
  const double s = w.squaredNorm();
  const double a = 1 - s / 6 * (1 - s / 20 * (1 - s / 42)), b = 0.5 * (1 - s / 12 * (1 - s / 30 * (1 - s / 56)));
  Matrix3 k;
  k << 0, -w[2], w[1], w[2], 0, -w[0], -w[1], w[0], 0;
  Matrix3 r = Matrix3::Identity() + a * k + b * k * k;
  for (int squaring = 0; squaring < 6; ++squaring) r = Matrix3(r * r);
  return renormalised(r);
}

StrainPath::StrainPath(const FrameSplit& increment, bool turning)
    : whole(increment),
      turn_(turning ? rotation_vector(increment.rotation) : Vector3::Zero()),
      turns_(turning && !(increment.rotation.array() == Matrix3::Identity().array()).all()) {}

Matrix3 StrainPath::at(double s) const {
  const Matrix3 identity = Matrix3::Identity();
  const Matrix3 stretch = s == 1 ? whole.stretch : Matrix3(identity + s * (whole.stretch - identity));
  const Matrix3 rotation = !turns_ ? identity : (s == 1 ? whole.rotation : rotation_matrix(s * turn_));
  return rotation * stretch;
}

double StrainPath::strain() const {
  return 0.5 * (whole.stretch.transpose() * whole.stretch - Matrix3::Identity()).norm();
}

Matrix3 turned_since(const Matrix3& start_frame, const Cell& cell) {
  if ((cell.rotation.array() == start_frame.array()).all()) return Matrix3::Identity();
  return renormalised(start_frame.transpose() * cell.rotation);
}

FrameSplit next_part(const Matrix3& start_frame, const Cell& cell, const Matrix3& done, const Matrix3& next) {
  Cell since_start = cell;
  since_start.rotation = turned_since(start_frame, cell);
  return split_increment(since_start, next * done.inverse() - Matrix3::Identity());
}

}  // namespace rvelab
