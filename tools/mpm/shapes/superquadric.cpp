#include "tools/mpm/shapes/superquadric.hpp"

namespace mpm {
namespace {

/// (u^n + v^n)^(1/n) of two numbers that are not negative.
double pair_norm(double u, double v, double n) {
  const double larger = std::max(u, v), smaller = std::min(u, v);
  if (!(smaller > 0)) return larger;
  return larger * std::pow(1 + std::pow(smaller / larger, n), 1 / n);
}

/// A norm of two with its first and second derivatives.
struct Pair {
  double value, du, dv, duu, duv, dvv;
  Pair(double u, double v, double n) {
    value = pair_norm(u, v, n);
    const double x = u / value, y = v / value, x2 = std::pow(x, n - 2), y2 = std::pow(y, n - 2);
    du = x * x2;
    dv = y * y2;
    duu = (n - 1) / value * x2 * (y * dv);
    dvv = (n - 1) / value * y2 * (x * du);
    duv = -(n - 1) / value * du * dv;
  }
};

template <int D>
Vec<D> signs_of(const Vec<D>& x) {
  return x.unaryExpr([](double value) { return value < 0 ? -1.0 : 1.0; });
}

double beta(double x, double y) { return std::tgamma(x) * std::tgamma(y) / std::tgamma(x + y); }

/// The largest a u + b v where (u^m + v^m) = 1, m = n/2: the dual norm.
double largest_sum(double a, double b, double n) { return n > 2 ? pair_norm(a, b, n / (n - 2)) : std::max(a, b); }

}  // namespace

template <int D>
Superquadric<D>::Superquadric(const Vec<D>& half_axes, double first, double second)
    : half(half_axes), n1(first), n2(second), rolling_radius(0) {
  constexpr int parts = 16;
  constexpr double right_angle = 1.5707963267948966;
  double sharpest = 0;
  for (int i = 0; i <= parts; ++i) {
    for (int j = 0; j <= (D == 3 ? parts : 0); ++j) {
      const double around = right_angle * i / parts, up = right_angle * j / parts;
      Vec<D> direction, normal;
      direction.template head<2>() << std::cos(up) * std::cos(around), std::cos(up) * std::sin(around);
      if (D == 3) direction[D - 1] = std::sin(up);
      Mat<D> curvature;
      bend(support(direction), normal, curvature);
      // the larger eigenvalue of a matrix that is not negative: between trace and half of it
      const double trace = curvature.trace(), square = curvature.squaredNorm();
      sharpest = std::max(sharpest, 0.5 * (trace + std::sqrt(std::max(0.0, 2 * square - trace * trace))));
    }
  }
  rolling_radius = 0.8 / sharpest;
}

template <int D>
double Superquadric<D>::gauge(const Vec<D>& x) const {
  const Vec<D> p = x.cwiseAbs().cwiseQuotient(half);
  if constexpr (D == 2) {
    return pair_norm(p[0], p[1], n1);
  } else {
    return pair_norm(pair_norm(p[0], p[1], n2), p[2], n1);
  }
}

template <int D>
double Superquadric<D>::height(const Vec<D>& direction) const {
  const Vec<D> p = direction.cwiseAbs().cwiseProduct(half);
  const double q1 = n1 / (n1 - 1);
  if constexpr (D == 2) {
    return pair_norm(p[0], p[1], q1);
  } else {
    return pair_norm(pair_norm(p[0], p[1], n2 / (n2 - 1)), p[2], q1);
  }
}

template <int D>
Vec<D> Superquadric<D>::support(const Vec<D>& direction) const {
  const Vec<D> p = direction.cwiseAbs().cwiseProduct(half);
  const double q1 = n1 / (n1 - 1);
  Vec<D> x;
  // The gradient of the height: of a norm of u and v it is (u/norm)^(q - 1).
  const auto share = [](double part, double norm, double n) {
    return part > 0 ? std::pow(part / norm, 1 / (n - 1)) : 0.0;
  };
  if constexpr (D == 2) {
    const double h = pair_norm(p[0], p[1], q1);
    x << share(p[0], h, n1), share(p[1], h, n1);
  } else {
    const double s = pair_norm(p[0], p[1], n2 / (n2 - 1)), h = pair_norm(s, p[2], q1), level = share(s, h, n1);
    x << level * share(p[0], s, n2), level * share(p[1], s, n2), share(p[2], h, n1);
  }
  return x.cwiseProduct(half).cwiseProduct(signs_of<D>(direction));
}

template <int D>
void Superquadric<D>::bend(const Vec<D>& x, Vec<D>& normal, Mat<D>& curvature) const {
  const Vec<D> signs = signs_of<D>(x), p = x.cwiseAbs().cwiseQuotient(half);
  Vec<D> gradient;
  if constexpr (D == 2) {
    const Pair g(p[0], p[1], n1);
    gradient << g.du, g.dv;
    curvature << g.duu, g.duv, g.duv, g.dvv;
  } else if (p[0] > 0 || p[1] > 0) {
    const Pair s(p[0], p[1], n2), g(s.value, p[2], n1);
    const Vec<3> inner(s.du, s.dv, 0);
    gradient = g.du * inner + Vec<3>(0, 0, g.dv);
    curvature << s.duu, s.duv, 0, s.duv, s.dvv, 0, 0, 0, 0;
    curvature = (g.du * curvature + g.duu * inner * inner.transpose()).eval();
    curvature(0, 2) = curvature(2, 0) = g.duv * s.du;
    curvature(1, 2) = curvature(2, 1) = g.duv * s.dv;
    curvature(2, 2) = g.dvv;
  } else {  // the pole, flat unless n1 = 2
    gradient = Vec<3>(0, 0, 1);
    curvature.setZero();
    if (n1 == 2 && n2 == 2) curvature(0, 0) = curvature(1, 1) = 1 / p[2];
  }
  const Vec<D> scale = signs.cwiseQuotient(half);
  gradient = gradient.cwiseProduct(scale).eval();
  const double length = gradient.norm();
  normal = gradient / length;
  curvature = (scale.asDiagonal() * curvature * scale.asDiagonal()).eval();
  const Mat<D> project = Mat<D>::Identity() - normal * normal.transpose();
  curvature = (project * curvature * project / length).eval();
}

template <int D>
Vec<D> Superquadric<D>::normal(const Vec<D>& x) const {
  Vec<D> normal;
  Mat<D> curvature;
  bend(retract(x), normal, curvature);
  return normal;
}

/// Where the ray from a point inside along an axis leaves; no entry of r is negative.
template <int D>
Vec<D> Superquadric<D>::exit(Vec<D> r, int axis) const {
  const auto rest = [](double norm, double part, double n) {  // w with w^n + part^n = norm^n
    return norm * std::pow(std::max(0.0, 1 - std::pow(part / norm, n)), 1 / n);
  };
  const Vec<D> p = r.cwiseQuotient(half);
  if constexpr (D == 2) {
    r[axis] = half[axis] * rest(1, p[1 - axis], n1);
  } else if (axis == 2) {
    r[2] = half[2] * rest(1, pair_norm(p[0], p[1], n2), n1);
  } else {
    r[axis] = half[axis] * rest(rest(1, p[2], n1), p[1 - axis], n2);
  }
  return retract(r);
}

/// The foot by Newton on the surface. x moves along it by y: the way r - x - f normal to go is F, f = normal.(r - x),
/// and (1 + f curvature) y = F.
template <int D>
Vec<D> Superquadric<D>::foot_from(Vec<D> x, const Vec<D>& r) const {
  using Square = Eigen::Matrix<double, D - 1, D - 1>;
  Vec<D> n, n_trial;
  Mat<D> K, K_trial;
  bend(x, n, K);
  Vec<D> F = (r - x) - n * n.dot(r - x);
  for (int step = 0; step < 100; ++step) {
    const double far = (r - x).squaredNorm(), f = n.dot(r - x);
    if (F.norm() < 1e-16 * (half.minCoeff() + r.norm())) break;
    const auto T = across<D>(n);
    const Square Q = Square::Identity() + f * (T.transpose() * K * T);
    const Vec<D> y = T * descent<D>(Q, T.transpose() * F);
    bool moved = false;
    for (double part = 1; part > 1e-6 && !moved; part /= 2) {
      const Vec<D> trial = retract(x + part * y);
      bend(trial, n_trial, K_trial);
      const Vec<D> away = r - trial, F_trial = away - n_trial * n_trial.dot(away);
      const double far_trial = away.squaredNorm();
      moved = far_trial < far - 1e-4 * part * F.dot(y) ||
              (far_trial <= far * (1 + 1e-14) && F_trial.norm() < 0.9 * F.norm());
      moved = moved && (f <= 0 || n_trial.dot(away) > 0);
      if (!moved) continue;
      x = trial;
      n = n_trial;
      K = K_trial;
      F = F_trial;
    }
    if (!moved) break;
  }
  return x;
}

template <int D>
double Superquadric<D>::distance(const Vec<D>& r, Vec<D>& outward) const {
  const Vec<D> signs = signs_of<D>(r), at = r.cwiseAbs();
  const double level = gauge(at);
  Vec<D> foot = Vec<D>::Zero();
  if (level >= 1) {
    foot = foot_from(at / level, at);
  } else {  // the nearest of the feet that each axis and the ray lead to
    double nearest = 1e300;
    for (int start = 0; start <= D; ++start) {
      if (start == D && !(level > 1e-6)) continue;
      const Vec<D> found = foot_from(start < D ? exit(at, start) : Vec<D>(at / level), at);
      const double far = (at - found).norm();
      if (far >= nearest - 1e-13 * half.minCoeff()) continue;
      nearest = far;
      foot = found;
    }
  }
  Mat<D> curvature;
  bend(foot, outward, curvature);
  const double distance = outward.dot(at - foot);
  outward = outward.cwiseProduct(signs).eval();
  return distance;
}

template <int D>
double Superquadric<D>::volume() const {
  if constexpr (D == 2) {
    return 4 * half.prod() * std::pow(std::tgamma(1 + 1 / n1), 2) / std::tgamma(1 + 2 / n1);
  } else {
    const double e1 = 2 / n1, e2 = 2 / n2;
    return 2 * half.prod() * e1 * e2 * beta(e1 / 2 + 1, e1) * beta(e2 / 2, e2 / 2);
  }
}

/// Space: Jaklic, Leonardis and Solina 2000, Segmentation and recovery of superquadrics. Plane: integrals
/// of u^2 over u^n + v^n < 1 by Dirichlet.
template <int D>
Vec<D> Superquadric<D>::inertia() const {
  const Vec<D> squares = half.cwiseAbs2();
  if constexpr (D == 2) {
    const double each = std::tgamma(3 / n1) * std::tgamma(1 / n1) / (n1 * n1 * std::tgamma(1 + 4 / n1));
    return Vec<2>::Constant(4 * half.prod() * each * squares.sum());
  } else {
    const double e1 = 2 / n1, e2 = 2 / n2, whole = half.prod() * e1 * e2 / 2;
    const double flat = beta(1.5 * e2, e2 / 2) * beta(e1 / 2, 2 * e1 + 1);
    const double tall = 4 * squares[2] * beta(e2 / 2, e2 / 2 + 1) * beta(1.5 * e1, e1 + 1);
    return whole * Vec<3>(squares[1] * flat + tall, squares[0] * flat + tall, (squares[0] + squares[1]) * flat);
  }
}

template <int D>
double Superquadric<D>::bounding_radius() const {
  const Vec<D> squares = half.cwiseAbs2();
  if constexpr (D == 2) {
    return std::sqrt(largest_sum(squares[0], squares[1], n1));
  } else {
    return std::sqrt(largest_sum(largest_sum(squares[0], squares[1], n2), squares[2], n1));
  }
}

template <int D>
Eigen::Matrix<double, D, D - 1> across(const Vec<D>& n) {
  Eigen::Matrix<double, D, D - 1> T;
  if constexpr (D == 2) {
    T << -n[1], n[0];
  } else {
    int axis = 0;
    n.cwiseAbs().minCoeff(&axis);
    T.col(0) = n.cross(Vec<3>::Unit(axis)).normalized();
    T.col(1) = n.cross(Vec<3>(T.col(0)));
  }
  return T;
}

template <int D>
Eigen::Matrix<double, D - 1, 1> descent(const Eigen::Matrix<double, D - 1, D - 1>& Q,
                                        const Eigen::Matrix<double, D - 1, 1>& F) {
  if constexpr (D == 2) {
    return F / std::max(std::abs(Q(0, 0)), 1e-12);
  } else {
    if (Q.determinant() > 1e-12 && Q.trace() > 0) return Q.inverse() * F;
    const double middle = 0.5 * Q.trace(), half_difference = 0.5 * (Q(0, 0) - Q(1, 1));
    const double apart = std::hypot(half_difference, Q(0, 1)), angle = 0.5 * std::atan2(Q(0, 1), half_difference);
    const Vec<2> first(std::cos(angle), std::sin(angle)), second(-first[1], first[0]);  // of middle + apart, - apart
    const auto size = [](double eigenvalue) { return std::max(std::abs(eigenvalue), 1e-12); };
    return first * (first.dot(F) / size(middle + apart)) + second * (second.dot(F) / size(middle - apart));
  }
}

template struct Superquadric<2>;
template struct Superquadric<3>;
template Eigen::Matrix<double, 2, 1> across<2>(const Vec<2>&);
template Eigen::Matrix<double, 3, 2> across<3>(const Vec<3>&);
template Eigen::Matrix<double, 1, 1> descent<2>(const Eigen::Matrix<double, 1, 1>&, const Eigen::Matrix<double, 1, 1>&);
template Eigen::Matrix<double, 2, 1> descent<3>(const Mat<2>&, const Vec<2>&);

}  // namespace mpm
