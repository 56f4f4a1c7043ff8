#include "rvelab/solver/quasi_static/error_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "rvelab/cell/cell.hpp"
#include "rvelab/solver/assembly/contact_states.hpp"
#include "rvelab/solver/quasi_static/accuracy.hpp"

namespace rvelab {

using namespace constants;

bool by_tolerance(const State& s) {
  return s.model().options.fixed_substeps == 0 && s.model().options.target_unbalanced == 0;
}

double pressure(State& s) { return mean_pressure(s.stress(), s.model().dimension()); }

double pressure_scale(State& s) { return std::max(pressure(s), least_pressure * s.control().reference_pressure); }

double network_change(const State& s, double strain) { return s.control().network_stiffness * strain; }

double overlap_strain(State& s) {
  const double network = s.control().network_stiffness;
  return network > 0 ? strain_of_overlap(pressure_scale(s), network, s.model().hardening)
                     : std::numeric_limits<double>::infinity();
}

double allowed_by_tolerances(State& s, double stress_change, double network) {
  const SolverOptions& o = s.model().options;
  return allowed_error(o.relative_tolerance, o.absolute_tolerance, stress_change, network, pressure_scale(s));
}

double error_factor(const State& s) {
  return error_per_unbalance(s.control().network_stiffness_ratio, s.control().constraint_ratio,
                             s.model().damping.local_quasi_static, s.model().dimension());
}

double expected_error(State& s, double ratio) { return error_factor(s) * pressure_scale(s) * ratio; }

double allowed_on_path(State& s, double network) {
  return allowed_by_tolerances(s, s.control().network_stiffness_ratio * network, network);
}

double target_ratio(State& s, double network) {
  if (s.model().options.target_unbalanced > 0) return s.model().options.target_unbalanced;
  if (!(pressure(s) > 0)) return largest_target;
  return std::clamp(allowed_on_path(s, network) / (step_margin * expected_error(s, 1)), least_target, largest_target);
}

double error_factor_of_start(const State& s) {
  return error_per_unbalance_of_start(s.model().rolling_constraint_factor * s.control().constraint_ratio);
}

double factor_of_last_start(const State& s) {
  return s.control().measured_error_factor == 0 && s.control().strain_since_measurement == start_mark
             ? error_factor_of_start(s)
             : 0;
}

double target_ratio_of_start(State& s, double network, double factor) {
  return std::clamp(allowed_on_path(s, network) / (start_margin * factor * pressure_scale(s)), least_target,
                    largest_target_of_start);
}

double held_tolerance(const State& s) {
  return std::max(s.model().options.relative_tolerance, s.model().options.absolute_tolerance);
}

double held_target_ratio(const State& s) {
  if (s.model().options.target_unbalanced > 0) return s.model().options.target_unbalanced;
  return std::clamp(held_path_ratio(held_tolerance(s)), least_target, largest_target_of_held_path);
}

void judge_equilibrium(State& s, Report& report, double least_target_ratio) {
  const double known = s.control().target_unbalanced_ratio > 0 ? s.control().target_unbalanced_ratio
                                                               : target_ratio(s, 0);  // nothing loaded yet
  const double target = std::max(known, least_target_ratio);
  report.quasi_static = report.unbalanced_ratio <= quasi_static_ratio * target && report.target_held;
}

namespace {

Matrix3 stress_in_lab(const Model& f, const Assembly& a) {
  return -a.cell.rotation * contact_moment(f, a) * a.cell.rotation.transpose() / a.cell.volume();
}

bool can_measure_lag(State& s) {
  return by_tolerance(s) && s.ratio_is_measured() && s.control().unbalanced_ratio > 0 && pressure(s) > 0;
}

bool lag_is_due(State& s, long substeps, bool from_rest) {
  const SolverState& control = s.control();
  if (from_rest) return substeps >= least_start && can_measure_lag(s);
  const bool old = control.steps_since_measurement >= (control.measured_error_factor > 0 ? rest_period : first_period);
  if (!(old || substeps >= least_increment) || !can_measure_lag(s)) return false;
  const double strain = control.strain_since_measurement >= slow_mark ? control.strain_since_measurement - slow_mark
                                                                      : control.strain_since_measurement;
  return old || control.measured_error_factor == 0 ||
         (control.steps_since_measurement >= changed_period && strain > overlap_strain(s));
}

/// Relaxes a copy, and notes in the state by what its stress was behind.
void measure_lag(State& s) {
  constexpr long part = rest_steps / 2;
  const FrameSplit still{Matrix3::Identity(), Matrix3::Identity(), true};
  const Matrix3 before = stress_in_lab(s.model(), s.assembly());
  Assembly relaxed = s.assembly();
  double changes[2];
  for (double& change : changes) {
    advance(s.model(), relaxed, {still, part, 1, Loading::quasi_static});
    change = (stress_in_lab(s.model(), relaxed) - before).norm();
  }
  const double change = std::max(changes[0], changes[1]);
  s.count(2 * part);
  SolverState& control = s.control();
  const double scale = pressure_scale(s), left = s.unbalanced_ratio(balance_of(s.model(), relaxed));
  const double margin = control.measured_error_factor > 0 ? 1 : first_margin;
  control.measured_error_factor = margin * (change + left_by_rest * left * scale) / (control.unbalanced_ratio * scale);
  control.steps_since_measurement = 0;
  // A change that grows with time is the beginning of a slow one: estimate_error takes it for that.
  control.strain_since_measurement = changes[1] > slow_growth * changes[0] ? slow_mark : 0;
  control.constraint_ratio = constraint_ratio(s.model(), s.assembly());
}

void judge_tolerance(Report& report) {
  report.tolerance_met = report.error_estimate <= met_margin * report.allowed_error;
}

}  // namespace

void estimate_error(State& s, double network, const Matrix3& stress_before, const Judged& increment, Report& report) {
  if (increment.strain > 0 && report.substeps >= long_increment && can_measure_lag(s)) measure_lag(s);
  double changed = (s.stress() - stress_before).norm();
  // A piece of a path is judged as its sub-steps are chosen (target_ratio), by what the path changes of the stress.
  if (network > network_change(s, increment.strain))
    changed = std::max(changed, s.control().network_stiffness_ratio * network);
  Judged judged = increment;
  judged.usual = allowed_on_path(s, network);
  estimate_error(s, allowed_by_tolerances(s, changed, network), judged, report);
}

void estimate_error(State& s, double allowed, const Judged& increment, Report& report) {
  SolverState& control = s.control();
  control.strain_since_measurement += increment.strain;
  const bool from_rest = increment.factor_from_rest > 0;
  if (increment.strain > 0 && lag_is_due(s, report.substeps, from_rest)) measure_lag(s);
  report.allowed_error = allowed;
  const double scale = pressure_scale(s) * increment.unbalanced_ratio, overlap = overlap_strain(s);
  const bool just_measured = control.measured_error_factor > 0 && control.steps_since_measurement == 0;
  const double begun = just_measured && control.strain_since_measurement >= slow_mark ? slow_goes_on : 1;
  const double measured =
      begun * measured_margin * control.measured_error_factor * scale * rested_growth(increment.strain, overlap);
  const double margin = from_rest                           ? start_estimate_margin
                        : control.measured_error_factor > 0 ? fitted_margin
                                                            : unmeasured_margin;
  const double factor = from_rest ? increment.factor_from_rest : error_factor(s);
  const double fitted = margin * factor * scale * error_growth(increment.strain, overlap);
  const double least = increment.strain > overlap ? least_share_of_long : least_share;
  const double lag = (just_measured ? measured : from_rest ? fitted : std::max(measured, fitted)) + increment.more;
  if (from_rest && control.measured_error_factor == 0) control.strain_since_measurement = start_mark;
  report.error_estimate = std::sqrt(lag * lag + increment.apart * increment.apart) +
                          least * (increment.usual > 0 ? increment.usual : allowed);
  judge_tolerance(report);
}

void estimate_way(State& s, double strain, double ratio_of_way, Report& report) {
  const double way = std::min(strain / overlap_strain(s), 1.0) * expected_error(s, ratio_of_way);
  report.error_estimate = std::sqrt(report.error_estimate * report.error_estimate + way * way);
  judge_tolerance(report);
}

}  // namespace rvelab
