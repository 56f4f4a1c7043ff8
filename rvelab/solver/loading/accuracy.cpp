#include "rvelab/solver/loading/accuracy.hpp"

#include <algorithm>
#include <cmath>

namespace rvelab {

namespace {

constexpr double share_of_directions = 0.7;

}  // namespace

double network_stiffness(double pressure, double mean_overlap, double diameter, double hardening) {
  return pressure > 0 && mean_overlap > 0 ? share_of_directions * hardening * pressure * diameter / mean_overlap : 0.0;
}

double strain_of_overlap(double pressure, double network_stiffness, double hardening) {
  return hardening * share_of_directions * pressure / network_stiffness;
}

double allowed_error(double relative, double absolute, double stress_change, double network_change, double pressure) {
  return relative * std::max(stress_change, 0.1 * network_change) + absolute * std::max(pressure, 0.0);
}

double grip_of(double friction) { return friction / (friction + accuracy::half_grip); }

double error_per_unbalance(double softness, double constraint_ratio, double damping, int dimension) {
  const double s = std::clamp(softness, 0.4, 1.0);
  const double soft = 0.4 / (s * s * std::sqrt(s)) / (dimension == 3 ? s : 1.0);
  const double damped = std::max(1.0, 0.1 + 3 * damping);
  if (!(constraint_ratio > 0)) return damped * soft;
  const double beyond = std::max(constraint_ratio, 1.0) - 1;
  return damped * std::max(soft, 0.3 + 1.7 / (1 + 70 * beyond * beyond));
}

double error_growth(double strain, double strain_of_overlap) {
  const double x = strain / strain_of_overlap / 0.3;
  if (!(x > 1)) return 1;
  const double root = std::sqrt(x);
  return root * std::sqrt(root);
}

double rested_growth(double strain, double strain_of_overlap) {
  return std::sqrt(std::sqrt(std::sqrt(std::max(1.0, strain / strain_of_overlap))));
}

double unbalance_of_start(double mismatch, double strain, double strain_of_overlap, double steps) {
  // n^-11/8 by roots, which give the same bits everywhere.
  const double root = std::sqrt(std::sqrt(steps));
  const double x = strain / strain_of_overlap;
  return mismatch * x * (1 + 2 * x) * std::min(0.45, 1 / (steps * root * std::sqrt(root)));
}

}  // namespace rvelab
