#include "rvelab/solver/quasi_static/error_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "rvelab/cell/cell.hpp"
#include "rvelab/solver/assembly/contact_states.hpp"
#include "rvelab/solver/quasi_static/accuracy.hpp"

namespace rvelab {

using namespace constants;

bool by_tolerance(const State& state) {
  return state.model().options.fixed_substeps == 0 && state.model().options.target_unbalanced == 0;
}

double pressure(State& state) {
  const int d = state.model().dimension();
  const double mean = mean_pressure(state.stress(), d);
  if (!has_interactions(state.assembly())) return mean;
  return mean + 2 * state.interaction_sums().pull / (d * state.cell().volume());
}

double network_stiffness(State& state) {
  const Model& model = state.model();
  const double overlap = state.out_of_balance().mean_overlap, diameter = 2 * model.mean_radius;
  if (!has_interactions(state.assembly()))
    return network_stiffness(pressure(state), overlap, diameter, model.hardening);
  // As accuracy.hpp, share_of_directions (1/dV) sum k l^2; the contacts bear what is left of the forces.
  const InteractionSums& sums = state.interaction_sums();
  const double volumes = model.dimension() * state.cell().volume();
  return network_stiffness(pressure(state) - (sums.push + sums.pull) / volumes, overlap, diameter, model.hardening) +
         share_of_directions * sums.stiffness / volumes;
}

double pressure_scale(State& state) { return std::max(pressure(state), least_pressure * state.reference().pressure); }

double elastic_stress_change(const State& state, double strain) {
  return state.control().interval.network_stiffness * strain;
}

double overlap_strain(State& state) {
  const double stiffness = state.control().interval.network_stiffness;
  return stiffness > 0 ? strain_of_overlap(pressure_scale(state), stiffness, state.model().hardening)
                       : std::numeric_limits<double>::infinity();
}

double allowed_by_tolerances(State& state, double stress_change, double elastic_change) {
  const SolverOptions& o = state.model().options;
  return allowed_error(o.relative_tolerance, o.absolute_tolerance, stress_change, elastic_change,
                       pressure_scale(state));
}

double fitted_error_factor(const State& state) {
  return error_per_unbalance(state.control().stiffness_ratio, state.control().constraint_ratio,
                             state.model().damping.local_quasi_static, state.model().dimension());
}

double expected_error(State& state, double ratio) { return fitted_error_factor(state) * pressure_scale(state) * ratio; }

double allowed_on_path(State& state, double elastic_change) {
  return allowed_by_tolerances(state, state.control().stiffness_ratio * elastic_change, elastic_change);
}

double target_ratio(State& state, double elastic_change) {
  if (state.model().options.target_unbalanced > 0) return state.model().options.target_unbalanced;
  if (!(pressure(state) > 0)) return largest_target;
  return ratio_for(allowed_on_path(state, elastic_change), expected_error(state, 1));
}

double target_ratio_of_start(State& state, double elastic_change, double factor) {
  return std::clamp(allowed_on_path(state, elastic_change) / (start_margin * factor * pressure_scale(state)),
                    least_target, largest_target_of_start);
}

double error_factor_of_start(const State& state) {
  const Model& model = state.model();
  const bool clumps = model.bodies != nullptr && !moves_as_body(model.shape);
  return (clumps ? clump_factor_of_start : 1) *
         error_per_unbalance_of_start(model.rolling_constraint_factor * state.control().constraint_ratio);
}

double factor_of_last_start(const State& state) {
  return state.control().after_short_start ? error_factor_of_start(state) : 0;
}

double held_tolerance(const State& state) {
  return std::max(state.model().options.relative_tolerance, state.model().options.absolute_tolerance);
}

double held_target_ratio(const State& state) {
  if (state.model().options.target_unbalanced > 0) return state.model().options.target_unbalanced;
  return std::clamp(held_path_ratio(held_tolerance(state)), least_target, largest_target_of_held_path);
}

void judge_equilibrium(State& state, Report& report, double least_target_ratio) {
  const double known = state.control().target_unbalanced_ratio > 0 ? state.control().target_unbalanced_ratio
                                                                   : target_ratio(state, 0);  // nothing loaded yet
  const double target = std::max(known, least_target_ratio);
  report.in_equilibrium = report.unbalanced_ratio <= quasi_static_ratio * target && report.target_held;
}

namespace {

Matrix3 stress_in_lab(const Model& model, const Assembly& assembly) {
  return -assembly.cell.rotation * contact_virial(model, assembly) * assembly.cell.rotation.transpose() /
         assembly.cell.volume();
}

bool can_measure_lag(State& state) {
  return by_tolerance(state) && state.ratio_is_measured() && state.control().unbalanced_ratio > 0 &&
         pressure(state) > 0;
}

bool lag_is_due(State& state, const JudgedIncrement& increment, long substeps) {
  const LagMeasurement& lag = state.control().lag;
  const bool first = lag.error_factor == 0 && (substeps >= check_interval / 2 || lag.steps >= check_interval);
  const bool changed = lag.steps >= changed_period && lag.strain > overlap_strain(state);
  const bool due = first || changed || increment.events || lag.steps >= measured_period;
  return due && can_measure_lag(state);
}

/// Relaxes a copy, and notes in the state by what its stress was behind.
void measure_lag(State& state) {
  constexpr long part = check_interval / 2;
  const FrameSplit still{Matrix3::Identity(), Matrix3::Identity(), true};
  const Matrix3 before = stress_in_lab(state.model(), state.assembly());
  Assembly relaxed = state.assembly();
  double changes[2];
  for (double& change : changes) {
    make_substeps(state.model(), relaxed, {still, part, 1, Loading::quasi_static});
    change = (stress_in_lab(state.model(), relaxed) - before).norm();
  }
  state.count(2 * part);
  QuasiStaticControl& control = state.control();
  const double left = state.unbalanced_ratio(balance_of(state.model(), relaxed)) * pressure_scale(state);
  const double lag = std::max(changes[0], changes[1]) + left;
  control.lag = {lag / (control.unbalanced_ratio * pressure_scale(state)), changes[1] > slow_growth * changes[0]};
  control.constraint_ratio = constraint_ratio(state.model(), state.assembly());
}

/// Whether bridges pull grains together: forces without stiffness.
bool is_moist(State& state) {
  return has_interactions(state.assembly()) && state.interaction_sums().pull > 0 &&
         !(state.interaction_sums().stiffness > 0);
}

void judge_tolerance(Report& report) {
  report.tolerance_met = report.error_estimate <= met_margin * report.allowed_error;
}

}  // namespace

void estimate_by_tolerances(State& state, double elastic_change, const Matrix3& stress_before,
                            const JudgedIncrement& increment, Report& report) {
  double changed = (state.stress() - stress_before).norm();
  // A piece of a path is judged as its sub-steps are chosen (target_ratio), by what the path changes of the stress.
  if (elastic_change > elastic_stress_change(state, increment.strain))
    changed = std::max(changed, state.control().stiffness_ratio * elastic_change);
  JudgedIncrement judged = increment;
  judged.allowed_of_path = allowed_on_path(state, elastic_change);
  estimate_error(state, allowed_by_tolerances(state, changed, elastic_change), judged, report);
}

void estimate_error(State& state, double allowed, const JudgedIncrement& increment, Report& report) {
  QuasiStaticControl& control = state.control();
  control.lag.strain += increment.strain;
  if (increment.strain > 0 && lag_is_due(state, increment, report.substeps)) measure_lag(state);
  const LagMeasurement& lag = control.lag;
  const bool from_rest = increment.start_error_factor > 0, known = lag.error_factor > 0;
  if (increment.strain > 0) control.after_short_start = from_rest && !known;
  const double scale =
      pressure_scale(state) * increment.unbalanced_ratio * error_growth(increment.strain, overlap_strain(state));
  const double measured = lag.error_factor * scale;
  const double factor = from_rest ? increment.start_error_factor : fitted_error_factor(state);
  double behind = std::max(measured, fitted_margin * factor * scale);
  if (known && lag.steps == 0) behind = lag.grows ? slow_goes_on * measured : measured;
  if (is_moist(state)) behind *= moist_lag;
  behind += increment.creep_error + order_of_breaking * increment.broken_stress;
  report.allowed_error = allowed;
  report.error_estimate = std::sqrt(behind * behind + increment.extrapolation_error * increment.extrapolation_error) +
                          least_share * (increment.allowed_of_path > 0 ? increment.allowed_of_path : allowed);
  judge_tolerance(report);
}

void add_error_of_path(State& state, double strain, double path_lag, Report& report) {
  const double of_path = lags_left * std::min(strain / overlap_strain(state), 1.0) * path_lag;
  report.error_estimate = std::sqrt(report.error_estimate * report.error_estimate + of_path * of_path);
  judge_tolerance(report);
}

}  // namespace rvelab
