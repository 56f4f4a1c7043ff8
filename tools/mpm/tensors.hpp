// Small tensors of the plane (D = 2) and of space (D = 3), and the map that a velocity gradient makes over a step.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <stdexcept>

namespace mpm {

template <int D>
using Vec = Eigen::Matrix<double, D, 1>;
template <int D>
using Mat = Eigen::Matrix<double, D, D>;

inline constexpr const char* axis_names[3] = {"x", "y", "z"};

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

/// -log(I - L): with the velocity gradient times the step of the configuration that a step has come to, the logarithm
/// of its deformation increment. finite_increment of it is (I - L)^-1 - I, so that F moves as points do that went x = X
/// + L x. Of -L, with the minus in front: log(I + L), for a gradient in the configuration that the step began with. L
/// itself where a step would strain by half: then the map need not have a logarithm.
template <int D>
Mat<D> strain_of_step(const Mat<D>& L) {
  const double size = L.cwiseAbs().maxCoeff();
  if (!(size < 0.5 / D)) return L;
  const Mat<D> square = L * L;
  if (size < 1e-3) return L + square * (0.5 * Mat<D>::Identity() + (1.0 / 3) * L + 0.25 * square + 0.2 * square * L);
  // 2 artanh(Z), Z = L (2 I - L)^-1: its entries are below 0.34.
  const Mat<D> Z = L * (2 * Mat<D>::Identity() - L).inverse(), step = Z * Z;
  Mat<D> power = Z, sum = Z;
  for (int k = 3; k < 200; k += 2) {
    power = (power * step).eval();
    sum += power / k;
    if (power.cwiseAbs().maxCoeff() < 1e-17 * size) break;
  }
  return 2 * sum;
}

/// G (I + dt G)^-1: the velocity gradient G of points before a step in the configuration after it.
template <int D>
Mat<D> carried_gradient(const Mat<D>& G, double dt) {
  if (!(dt * G.cwiseAbs().maxCoeff() < 0.5 / D)) return G;
  return G * (Mat<D>::Identity() + dt * G).inverse();
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
