#include "rvelab/solver/loading/strain_path.hpp"

#include <Eigen/LU>
#include <cmath>

namespace rvelab {

Vector3 rotation_vector(const Matrix3& r) {
  // Quaternion, halved until the angle is small enough for the series of asin.
  double w;
  Vector3 v;
  if (const double trace = r.trace(); trace > 0) {
    const double s = std::sqrt(trace + 1) * 2;
    w = 0.25 * s;
    v = Vector3(r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1)) / s;
  } else {
    int i = 0;
    if (r(1, 1) > r(0, 0)) i = 1;
    if (r(2, 2) > r(i, i)) i = 2;
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double s = std::sqrt(r(i, i) - r(j, j) - r(k, k) + 1) * 2;
    v[i] = 0.25 * s;
    v[j] = (r(j, i) + r(i, j)) / s;
    v[k] = (r(k, i) + r(i, k)) / s;
    w = (r(k, j) - r(j, k)) / s;
    if (w < 0) {
      w = -w;
      v = -v;
    }
  }
  double factor = 2;
  for (int halving = 0; halving < 6; ++halving) {
    const double half = std::sqrt(0.5 * (1 + w));
    v /= 2 * half;
    w = half;
    factor *= 2;
  }
  const double s2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  const double series = 1 + s2 * (1.0 / 6 + s2 * (3.0 / 40 + s2 * (15.0 / 336)));
  return factor * series * v;
}

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
