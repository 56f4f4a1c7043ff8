#include "rvelab/solver/quasi_static/deferred.hpp"

#include <algorithm>
#include <cmath>

#include "rvelab/solver/quasi_static/accuracy.hpp"
#include "rvelab/solver/quasi_static/error_model.hpp"
#include "rvelab/solver/quasi_static/strain_step.hpp"

namespace rvelab {

using namespace constants;

Extrapolated extrapolated(const State& state, const Matrix3& stretch) {
  const DeferredStrain& deferred = state.control().deferred;
  const Matrix3 change = stretch - Matrix3::Identity(), &last = state.last_step().rate;
  const double rate = last.norm();
  const double along = rate > 0 ? change.cwiseProduct(last).sum() / rate : 0.0;
  const double across = rate > 0 ? (change - along / rate * last).norm() : change.norm();
  return {along * deferred.stress_slope, std::abs(along) * deferred.slope_error + elastic_stress_change(state, across)};
}

std::optional<Deferral> deferral_of(State& state, const FrameSplit& increment) {
  const QuasiStaticControl& control = state.control();
  if (increment.rigid || !by_tolerance(state) || state.last_step().loading != Loading::quasi_static ||
      !state.masses().in_use || control.deferred.stress_slope.isZero(0) || !(control.interval.network_stiffness > 0))
    return {};
  const Matrix3 change = increment.stretch - Matrix3::Identity(),
                stretch = increment.stretch * control.deferred.stretch;
  const double strain = change.norm();
  if ((stretch - Matrix3::Identity()).norm() + strain > part_of_step * control.strain_per_step) return {};
  // Increments off the path, for a tangent by differences, are never deferred.
  if (!(change.cwiseProduct(state.last_step().rate).sum() > along_path * strain * state.last_step().rate.norm()))
    return {};
  const double elastic_change = elastic_stress_change(state, control.strain_since_reversal);
  if (was_coarser(state, elastic_change)) return {};
  const Extrapolated after = extrapolated(state, stretch);
  if (!(after.error <= share_of_extrapolation * allowed_on_path(state, elastic_change))) return {};
  return Deferral{stretch, after, elastic_change};
}

Report defer(State& state, const FrameSplit& increment, const Deferral& deferral) {
  const QuasiStaticControl& control = state.control();
  const Matrix3 before = extrapolated(state, control.deferred.stretch).stress;
  state.set_deferred_and_turn(deferral.stretch, increment.rotation);
  Report report;
  report.unbalanced_ratio = control.unbalanced_ratio;
  const double of_start = factor_of_last_start(state);
  judge_equilibrium(state, report, of_start > 0 ? report.unbalanced_ratio : 0);
  const JudgedIncrement judged{.unbalanced_ratio = control.unbalanced_ratio,
                               .extrapolation_error = deferral.change.error,
                               .start_error_factor = of_start};
  estimate_by_tolerances(state, deferral.elastic_change, state.stress() + before - deferral.change.stress, judged,
                         report);
  return report;
}

bool is_along_deferred(const State& state, const FrameSplit& increment) {
  const Matrix3 change = increment.stretch - Matrix3::Identity(),
                deferred = state.control().deferred.stretch - Matrix3::Identity();
  return change.cwiseProduct(deferred).sum() > 0;
}

void note_slope(State& state, const Matrix3& stretch, const Matrix3& stress_before, bool same_frame) {
  DeferredStrain& deferred = state.control().deferred;
  const Matrix3& last = state.last_step().rate;
  const double rate = last.norm();
  const double along = (stretch - Matrix3::Identity()).cwiseProduct(last).sum() / rate;
  const bool known = same_frame && rate > 0 && along > 0;
  const Matrix3 slope = known ? Matrix3((state.stress() - stress_before) / along) : Matrix3(Matrix3::Zero());
  deferred.slope_error =
      std::max(change_of_slope * (slope - deferred.stress_slope).norm(), memory_of_slope * deferred.slope_error);
  deferred.stress_slope = slope;
}

}  // namespace rvelab
