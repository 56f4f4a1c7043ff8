#include "rvelab/solver/affine_stiffness.hpp"

#include <cmath>

namespace rvelab {

Matrix3 strain_matrix(const Vector6& e) {
  Matrix3 m;
  m << e[0], 0.5 * e[5], 0.5 * e[4], 0.5 * e[5], e[1], 0.5 * e[3], 0.5 * e[4], 0.5 * e[3], e[2];
  return m;
}

Vector6 strain_components(const Matrix3& m) {
  Vector6 e;
  e << m(0, 0), m(1, 1), m(2, 2), m(1, 2) + m(2, 1), m(0, 2) + m(2, 0), m(0, 1) + m(1, 0);
  return e;
}

Matrix6 affine_stiffness(const Fixture& f, const Assembly& a) {
  Matrix6 sum = Matrix6::Zero();
  const Matrix3& q = a.cell.rotation;
  for (std::size_t p = 0; p < a.pairs.listed; ++p) {
    const auto i = a.pairs.i[p], j = a.pairs.j[p];
    const Vector3 cell_branch = branch_of(f, a, p);
    const double length = cell_branch.norm(), overlap = (f.radius[i] + f.radius[j]) - length;
    if (!(overlap > 0)) continue;
    double kn = a.pairs.kn[p], kt = a.pairs.kt[p];
    if (f.law != KernelLaw::linear) kn *= 1.5 * std::sqrt(overlap);
    if (f.law == KernelLaw::hertz_mindlin) kt *= std::sqrt(overlap);
    const Vector3 n = q * cell_branch / length;
    // Strain of the contact: the branch changes by eps b; along n by n eps n, across by (eps n - n (n eps n)).
    Vector6 along;
    along << n[0] * n[0], n[1] * n[1], n[2] * n[2], n[1] * n[2], n[0] * n[2], n[0] * n[1];
    Eigen::Matrix<double, 3, 6> across;
    across << n[0], 0, 0, 0, 0.5 * n[2], 0.5 * n[1],  //
        0, n[1], 0, 0.5 * n[2], 0, 0.5 * n[0],        //
        0, 0, n[2], 0.5 * n[1], 0.5 * n[0], 0;
    across -= n * along.transpose();
    sum += (length * length) * (kn * along * along.transpose() + kt * across.transpose() * across);
  }
  return sum / a.cell.volume();
}

}  // namespace rvelab
