#include "rvelab/solver/quasi_static/accuracy.hpp"

#include <algorithm>
#include <cmath>

#include "rvelab/contact/model.hpp"

namespace rvelab {

using namespace constants;

namespace {

/// `factor` where contacts just hold the grains, c = 1, and less where they hold them more firmly.
double if_isostatic(double factor, double constraint_ratio) {
  const double beyond = std::max(constraint_ratio, 1.0) - 1;
  return factor / (1 + isostatic_width * beyond * beyond);
}

}  // namespace

double network_stiffness(double pressure, double mean_overlap, double diameter, double hardening) {
  return pressure > 0 && mean_overlap > 0 ? share_of_directions * hardening * pressure * diameter / mean_overlap : 0.0;
}

double strain_of_overlap(double pressure, double network_stiffness, double hardening) {
  return hardening * share_of_directions * pressure / network_stiffness;
}

double allowed_error(double relative, double absolute, double stress_change, double elastic_stress_change,
                     double pressure) {
  return relative * std::max(stress_change, least_change * elastic_stress_change) + absolute * std::max(pressure, 0.0);
}

double error_per_unbalance(double stiffness_ratio, double constraint_ratio, double damping, int dimension) {
  const double s = std::clamp(stiffness_ratio, least_stiffness_ratio, 1.0);
  const double soft = stiff_factor / (s * s * std::sqrt(s)) / (dimension == 3 ? s : 1.0);
  const double damped = std::max(1.0, damping / Damping{}.local_quasi_static);
  if (!(constraint_ratio > 0)) return damped * soft;
  return damped * std::max(soft, hyperstatic_factor + if_isostatic(isostatic_factor, constraint_ratio));
}

double error_per_unbalance_of_start(double constraint_ratio) {
  return firm_factor_of_start + if_isostatic(isostatic_factor_of_start, constraint_ratio);
}

double creep_after_relaxation(double constraint_ratio) { return 1 + if_isostatic(isostatic_creep, constraint_ratio); }

double error_growth(double strain, double strain_of_overlap) {
  return std::sqrt(std::sqrt(std::sqrt(std::max(1.0, strain / strain_of_overlap))));
}

double ratio_for(double allowed, double error_per_ratio) {
  return std::clamp(allowed / (step_margin * error_per_ratio), least_target, largest_target);
}

double unbalance_of_start(double mismatch, double strain, double strain_of_overlap, double steps) {
  // n^-11/8 by roots, which give the same bits everywhere.
  const double root = std::sqrt(std::sqrt(steps));
  const double x = strain / strain_of_overlap;
  return mismatch * x * (1 + 2 * x) * std::min(largest_start, 1 / (steps * root * std::sqrt(root)));
}

}  // namespace rvelab
