#include "rvelab/cell/volume.hpp"

#include <Eigen/LU>
#include <cmath>

#include "rvelab/error.hpp"

namespace rvelab {
namespace {

/// Cube root of a number near one by Newton's method: no libm in what touches state.
double cube_root_near_one(double x) {
  double y = 1;
  for (int step = 0; step < 60; ++step) y -= (y * y * y - x) / (3 * y * y);
  return y;
}

}  // namespace

Matrix3 with_volume_ratio(const Matrix3& displacement_gradient, double ratio, int dimension) {
  Matrix3 f = Matrix3::Identity() + displacement_gradient;
  const double off = ratio / f.determinant();
  if (!(off > 0)) throw InvalidIncrement("the increment turns the cell inside out; apply it in smaller parts");
  const double stretch = dimension == 2 ? std::sqrt(off) : cube_root_near_one(off);
  for (int k = 0; k < dimension; ++k) f.row(k) *= stretch;
  return f - Matrix3::Identity();
}

}  // namespace rvelab
