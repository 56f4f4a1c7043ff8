// Small tensors of the plane (D = 2) and of space (D = 3), and the map that a velocity gradient makes over a step.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <stdexcept>
#include <string>

namespace mpm {

template <int D>
using Vec = Eigen::Matrix<double, D, 1>;
template <int D>
using Mat = Eigen::Matrix<double, D, D>;

/// What a user can mend: the program tells it in one line and ends with code 2.
struct Mistake : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// exp(L) - I: the finite map of a constant velocity gradient over a step (L is the gradient times the step). A
/// rotation keeps its volume, which I + L does not.
template <int D>
Mat<D> finite_increment(const Mat<D>& L) {
  const double size = L.cwiseAbs().maxCoeff();
  if (!(size < 0.05)) {
    if (!(size < 1e3)) throw std::runtime_error("a velocity gradient has grown without bound; take a smaller time.cfl");
    const Mat<D> half = finite_increment<D>(0.5 * L);
    return 2 * half + half * half;
  }
  const Mat<D> square = L * L;
  if (size < 1e-3) {  // four terms: of a step this small there are many
    const Mat<D> rest = 0.5 * Mat<D>::Identity() + (1.0 / 6) * L + (1.0 / 24) * square;
    return L + square * rest;
  }
  Mat<D> power = 0.5 * square, sum = L + power;
  for (int k = 3; k <= 8; ++k) {
    power = ((1.0 / k) * (power * L)).eval();
    sum += power;
  }
  return sum;
}

/// sqrt(2 e:e) in the plane and sqrt(2 e:e/3) in space, e the deviator.
template <int D>
double deviatoric_strain(const Mat<D>& strain) {
  const Mat<D> e = strain - strain.trace() / D * Mat<D>::Identity();
  return std::sqrt((D == 2 ? 2.0 : 2.0 / 3) * e.squaredNorm());
}

/// p (compression positive) and q: sqrt(s:s/2) in the plane, sqrt(3 s:s/2) in space.
template <int D>
double mean_pressure(const Mat<D>& stress) {
  return -stress.trace() / D;
}
template <int D>
double deviatoric_stress(const Mat<D>& stress) {
  const Mat<D> s = stress - stress.trace() / D * Mat<D>::Identity();
  return std::sqrt((D == 2 ? 0.5 : 1.5) * s.squaredNorm());
}

/// Rotation of the polar decomposition F = R U about z, in space about its own axis; degrees, anticlockwise positive.
template <int D>
double rotation_degrees(const Mat<D>& F) {
  constexpr double degrees = 57.29577951308232;
  if constexpr (D == 2) {
    return std::atan2(F(1, 0) - F(0, 1), F(0, 0) + F(1, 1)) * degrees;
  } else {
    const Eigen::JacobiSVD<Mat<D>> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Mat<D> R = svd.matrixU() * svd.matrixV().transpose();
    return std::acos(std::min(1.0, std::max(-1.0, 0.5 * (R.trace() - 1)))) * degrees;
  }
}

}  // namespace mpm
