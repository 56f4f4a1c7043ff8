#include "rvelab/solver/quasi_static/deferred.hpp"

#include <algorithm>
#include <cmath>

#include "rvelab/solver/quasi_static/accuracy.hpp"
#include "rvelab/solver/quasi_static/error_model.hpp"
#include "rvelab/solver/quasi_static/strain_step.hpp"

namespace rvelab {

using namespace constants;

Extrapolated extrapolated(const State& s, const Matrix3& stretch) {
  const SolverState& control = s.control();
  const Matrix3 change = stretch - Matrix3::Identity();
  const double rate = control.last_rate.norm();
  const double along = rate > 0 ? change.cwiseProduct(control.last_rate).sum() / rate : 0.0;
  const double across = rate > 0 ? (change - along / rate * control.last_rate).norm() : change.norm();
  return {along * control.stress_slope, std::abs(along) * control.slope_error + across * control.network_stiffness};
}

bool may_defer(State& s, const FrameSplit& increment) {
  const SolverState& control = s.control();
  if (increment.rigid || !by_tolerance(s) || !control.quasi_static || control.steps_since_scaling < 0 ||
      control.stress_slope.isZero(0) || !(control.network_stiffness > 0))
    return false;
  const Matrix3 change = increment.stretch - Matrix3::Identity(),
                stretch = increment.stretch * control.deferred_stretch;
  const double strain = change.norm();
  if ((stretch - Matrix3::Identity()).norm() + strain > part_of_step * control.strain_per_step) return false;
  // Increments off the path, for a tangent by differences, are never deferred.
  if (!(change.cwiseProduct(control.last_rate).sum() > along_path * strain * control.last_rate.norm())) return false;
  const double network = network_change(s, control.strain_since_reversal);
  if (was_coarser(s, network)) return false;
  return extrapolated(s, stretch).error <= share_of_extrapolation * allowed_on_path(s, network);
}

Report defer(State& s, const FrameSplit& increment) {
  const SolverState& control = s.control();
  const Matrix3 before = extrapolated(s, control.deferred_stretch).stress;
  s.defer(increment.stretch * control.deferred_stretch, increment.rotation);
  Report report;
  report.unbalanced_ratio = control.unbalanced_ratio;
  const double of_start = factor_of_last_start(s);
  judge_equilibrium(s, report, of_start > 0 ? report.unbalanced_ratio : 0);
  const Extrapolated after = extrapolated(s, control.deferred_stretch);
  Judged judged{0, control.unbalanced_ratio, 0, after.error};
  judged.factor_from_rest = of_start;
  estimate_error(s, network_change(s, control.strain_since_reversal), s.stress() + before - after.stress, judged,
                 report);
  return report;
}

bool joins_deferred(const State& s, const FrameSplit& increment) {
  const Matrix3 change = increment.stretch - Matrix3::Identity(),
                deferred = s.control().deferred_stretch - Matrix3::Identity();
  return change.cwiseProduct(deferred).sum() > same_direction * change.norm() * deferred.norm();
}

void note_slope(State& s, const Matrix3& stretch, const Matrix3& stress_before, bool same_frame) {
  SolverState& control = s.control();
  const double rate = control.last_rate.norm();
  const double along = (stretch - Matrix3::Identity()).cwiseProduct(control.last_rate).sum() / rate;
  const bool known = same_frame && rate > 0 && along > 0;
  const Matrix3 slope = known ? Matrix3((s.stress() - stress_before) / along) : Matrix3(Matrix3::Zero());
  control.slope_error =
      std::max(change_of_slope * (slope - control.stress_slope).norm(), memory_of_slope * control.slope_error);
  control.stress_slope = slope;
}

}  // namespace rvelab
