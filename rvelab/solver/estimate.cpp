// What the stress of an increment at dt = 0 may err by. Now and then a copy of the state rests for some sub-steps, and
// shows by how much its stress was behind; in between the unbalanced-force ratio tells, by the factor that was found
// (loading/accuracy.hpp). Declared in rve_impl.hpp.
#include <algorithm>
#include <cmath>
#include <limits>

#include "rvelab/solver/loading/accuracy.hpp"
#include "rvelab/solver/rve_impl.hpp"

namespace rvelab {

namespace {

Matrix3 stress_in_lab(const Fixture& f, const Assembly& a) {
  return -a.cell.rotation * contact_moment(f, a) * a.cell.rotation.transpose() / a.cell.volume();
}

}  // namespace

double Rve::Impl::error_factor() const {
  return error_per_unbalance(now.state.softness, now.state.constraint_ratio, fixture.damping.local_quasi_static,
                             fixture.dimension());
}

double Rve::Impl::expected_error(double ratio) { return error_factor() * pressure_scale() * ratio; }

double Rve::Impl::overlap_strain() {
  const double network = now.state.network_stiffness;
  return network > 0 ? strain_of_overlap(pressure_scale(), network, fixture.hardening)
                     : std::numeric_limits<double>::infinity();
}

bool Rve::Impl::can_measure_lag() {
  return by_tolerance() && ratio_holds && now.state.unbalanced_ratio > 0 && pressure() > 0;
}

bool Rve::Impl::lag_is_due(long substeps) {
  const SolverState& state = now.state;
  if (!can_measure_lag()) return false;
  if (state.lag_steps >= accuracy::rest_period) return true;
  const bool changed = state.lag_strain > overlap_strain() && state.lag_steps >= accuracy::changed_period;
  return (state.lag_factor == 0 || changed) && substeps >= accuracy::least_increment;
}

void Rve::Impl::measure_lag() {
  constexpr long part = accuracy::rest_steps / 2;
  SolverState& state = now.state;
  const FrameSplit still{Matrix3::Identity(), Matrix3::Identity(), true};
  const Matrix3 before = stress_in_lab(fixture, now);
  Assembly rested = now;
  double changes[2];
  for (double& change : changes) {
    advance(fixture, rested, {still, part, 1, Loading::quasi_static});
    change = (stress_in_lab(fixture, rested) - before).norm();
  }
  grain_steps_made += std::uint64_t(2 * part) * fixture.size();
  const double change = std::max(changes[0], changes[1]);
  const double scale = pressure_scale(), left = unbalanced(balance_of(fixture, rested));
  const double margin = state.lag_factor > 0 ? 1 : accuracy::first_margin;
  state.lag_factor = margin * (change + accuracy::left_by_rest * left * scale) / (state.unbalanced_ratio * scale);
  state.lag_steps = 0;
  // A change that grows with time is the beginning of a slow one: judge_error takes it for that, and it is measured
  // again soon, as after a turn.
  state.lag_strain = changes[1] > accuracy::slow_growth * changes[0] ? 1 : 0;
  state.constraint_ratio = constraint_ratio();
}

void Rve::Impl::estimate_error(double strain, double network, const Matrix3& stress_before, double ratio, double more,
                               Report& report) {
  if (strain > 0 && can_measure_lag() && report.substeps >= accuracy::long_increment) measure_lag();
  double changed = (present_stress() - stress_before).norm();
  // A piece of a path is judged as the pace is (target_for), by what the path changes of the stress.
  if (network > network_change(strain)) changed = std::max(changed, now.state.softness * network);
  judge_error(allowed_by_tolerances(changed, network), strain, ratio, more, report);
}

void Rve::Impl::judge_error(double allowed, double strain, double ratio, double more, Report& report) {
  SolverState& state = now.state;
  state.lag_strain += strain;
  if (strain > 0 && lag_is_due(report.substeps)) measure_lag();
  report.allowed_error = allowed;
  const double scale = pressure_scale() * ratio, overlap = overlap_strain();
  const bool just_measured = state.lag_factor > 0 && state.lag_steps == 0;
  const double begun = just_measured && state.lag_strain >= 1 ? accuracy::slow_goes_on : 1;
  const double measured = begun * accuracy::measured_margin * state.lag_factor * scale * rested_growth(strain, overlap);
  const double margin = state.lag_factor > 0 ? accuracy::fitted_margin : accuracy::unmeasured_margin;
  const double fitted = margin * error_factor() * scale * error_growth(strain, overlap);
  const double least = strain > overlap ? accuracy::least_share_of_long : accuracy::least_share;
  report.error_estimate = (just_measured ? measured : std::max(measured, fitted)) + more + least * allowed;
  report.tolerance_met = report.error_estimate <= accuracy::met_margin * report.allowed_error;
}

void Rve::Impl::judge_way(double strain, double mean_ratio, Report& report) {
  const double overlaps = strain / overlap_strain();
  if (!(overlaps > 1)) return;
  const double way = accuracy::way_margin * std::sqrt(overlaps) * error_factor() * pressure_scale() * mean_ratio;
  report.error_estimate += way;
  report.tolerance_met = report.error_estimate <= accuracy::met_margin * report.allowed_error;
}

}  // namespace rvelab
