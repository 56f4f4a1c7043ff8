#include "rvelab/solver/quasi_static/quasi_static.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "rvelab/error.hpp"
#include "rvelab/solver/loading/strain_path.hpp"
#include "rvelab/solver/quasi_static/check.hpp"
#include "rvelab/solver/quasi_static/constants.hpp"
#include "rvelab/solver/quasi_static/deferred.hpp"
#include "rvelab/solver/quasi_static/error_model.hpp"
#include "rvelab/solver/quasi_static/relaxation.hpp"
#include "rvelab/solver/quasi_static/strain_step.hpp"

namespace rvelab {

using namespace constants;

namespace {

/// The network is elastic again after a reversal, and velocities that go the other way are worse than none: carried on
/// they left ten times the error.
void turn_back(State& s) {
  SolverState& control = s.control();
  s.stop_quasi_static();
  control.last_rate.setZero();
  control.network_stiffness_ratio = 1;
  control.interval_strain = 0;
  control.interval_stress = s.stress();
}

/// The sub-steps of an increment, and what its checks find.
class CheckedSteps {
 public:
  CheckedSteps(State& state, EquilibriumCheck& check, const StrainPath& path, const Start& start)
      : s_(state),
        check_(check),
        path_(path),
        strain_(path.strain()),
        most_(most_substeps(state, strain_)),
        fewest_(std::min(start.fewest, most_)),
        from_rest_(start.factor_from_rest > 0) {}

  /// Makes them; `substeps` were made before and counts on.
  void make(long& substeps) {
    const Matrix3 start_frame = s_.cell().rotation;
    Matrix3 done = Matrix3::Identity();
    while (fraction_ < 1) {
      const long steps = choose(substeps);
      const Matrix3 next = path_.at(fraction_);
      Advance part{next_part(start_frame, s_.cell(), done, next), steps};
      if (from_rest_) {
        part.step = std::max(1.0, start_step / s_.model().options.time_step_factor);
        part.damping = start_damping;
      }
      s_.advance(part);
      done = next;
      substeps += steps;
      s_.control().interval_strain += (fraction_ - before_) * strain_;
      end_is_checked_ = fraction_ == 1 ? check_.is_due_at_end(substeps, strain_) : check_.is_due();
      if (end_is_checked_) check();
    }
  }
  bool end_is_checked() const { return end_is_checked_; }
  /// Root of the sum of squares of the unbalanced ratios that the checks before the end found.
  double ratio_of_way() const { return std::sqrt(squares_); }

 private:
  /// Sub-steps until the next check; moves the fraction on.
  long choose(long made) {
    const SolverOptions& o = s_.model().options;
    double& strain_per_step = s_.control().strain_per_step;
    const double left = 1 - fraction_;
    // Where contacts open, perhaps no strain per step brings equilibrium: the number of sub-steps is limited, and the
    // estimate tells the error.
    strain_per_step =
        std::max(strain_per_step, left * strain_ / std::max(most_ - double(made), double(check_interval)));
    long steps_left = 0;
    by_strain_ = true;
    if (from_rest_) {
      steps_left = std::max(1L, std::lround(left * fewest_));
      by_strain_ = false;
    } else if (o.fixed_substeps > 0) {
      steps_left = std::max(1L, std::lround(left * double(o.fixed_substeps)));
      by_strain_ = false;
    } else {
      const double count = std::ceil(left * strain_ / strain_per_step - rounded_off),
                   at_least = std::ceil(left * fewest_);
      steps_left = long(std::clamp(std::max(count, at_least), 1.0, 1e15));
      by_strain_ = count >= at_least;
    }
    const bool hopeless = left * strain_ / step_of_gas > double(o.max_substeps);
    const bool settled = !by_strain_ || hopeless || made >= settling_steps;
    expect_substeps(s_, made + (settled ? steps_left : 1));
    const long steps = steps_left <= check_interval + check_interval / 2 ? steps_left : check_interval;
    before_ = fraction_;
    fraction_ = steps == steps_left ? 1.0 : fraction_ + left * double(steps) / double(steps_left);
    return steps;
  }

  void check() {
    const OutOfBalance balance = check_.check();
    const double ratio = s_.control().unbalanced_ratio;
    if (fraction_ < 1) squares_ += ratio * ratio;
    if (from_rest_) return;
    // Where the fewest steps rule, their strain is not that of the control, but it may still be found too large.
    const bool too_fast = s_.control().unbalanced_ratio > s_.control().target_unbalanced_ratio;
    if (s_.model().options.fixed_substeps == 0 && (by_strain_ || too_fast)) adapt_strain_step(s_, balance);
    // The transient has decayed: allow fewer sub-steps, where contacts stay what they are.
    constexpr double few = 2 * double(check_interval);
    const double left = 1 - before_;
    if (strain_ < overlap_strain(s_) && !too_fast && left * fewest_ > few)
      fewest_ = std::max(fewer_after_check * fewest_, few / left);
  }

  State& s_;
  EquilibriumCheck& check_;
  const StrainPath& path_;
  double strain_, most_, fewest_;
  bool from_rest_;
  double fraction_ = 0, before_ = 0, squares_ = 0;
  bool by_strain_ = true;  ///< the strain per step decides their number
  bool end_is_checked_ = false;
};

void join_deferred(State& s, FrameSplit& increment) {
  if (!s.has_deferred()) return;
  increment.stretch = (increment.stretch * s.control().deferred_stretch).eval();
  s.set_deferred(Matrix3::Identity());
}

/// Notes a turn of the path, before the increment that makes it.
void note_direction(State& s, double strain, bool turns, bool back, bool reverses) {
  SolverState& control = s.control();
  if (turns) control.strain_since_measurement = turn_mark;
  if (back) control.strain_since_reversal = 0;
  control.strain_since_reversal = std::min(control.strain_since_reversal + strain, judged_together);
  if (by_tolerance(s) && reverses) turn_back(s);
}

}  // namespace

void expect_substeps(const State& s, long needed) {
  if (needed <= s.model().options.max_substeps) return;
  throw IncrementFailed("the increment needs " + std::to_string(needed) + " sub-steps; solver.max_substeps allows " +
                        std::to_string(s.model().options.max_substeps));
}

Report load_quasi_static(State& s, FrameSplit whole) {
  Report report;
  SolverState& control = s.control();
  join_deferred(s, whole);
  EquilibriumCheck check(s);
  const Matrix3 start_frame = s.cell().rotation, change = whole.stretch - Matrix3::Identity();
  const StrainPath path(whole, false);
  const double strain = path.strain(), along = control.last_rate.cwiseProduct(change).sum();
  const bool turns = along < same_direction * strain * control.last_rate.norm();
  const Relaxed relaxed = by_tolerance(s) ? relax_before(s, check, strain, turns) : Relaxed();
  report.substeps += relaxed.steps;
  const Matrix3 stress_before = s.stress();
  note_direction(s, strain, turns, along <= 0, along < 0);

  const double network = network_change(s, std::max(strain, control.strain_since_reversal));
  set_target_ratio(s, target_ratio(s, network));
  const Start start = start_of(s, change, strain, network, along < 0);
  CheckedSteps substeps(s, check, path, start);
  substeps.make(report.substeps);
  if (!s.stress().allFinite())
    throw IncrementFailed("the increment led to values that are not finite; apply it in smaller parts");

  // Between checks the ratio that is expected of a start is used.
  if (!substeps.end_is_checked()) control.unbalanced_ratio = std::max(start.unbalanced_ratio, control.unbalanced_ratio);
  report.unbalanced_ratio = control.unbalanced_ratio;
  judge_equilibrium(s, report, start.factor_from_rest > 0 ? start.unbalanced_ratio : 0);
  Judged judged{strain, control.unbalanced_ratio, relaxed.creep};
  judged.factor_from_rest = start.factor_from_rest;
  estimate_error(s, network, stress_before, judged, report);
  estimate_way(s, strain, substeps.ratio_of_way(), report);
  note_slope(s, whole.stretch, stress_before, (s.cell().rotation.array() == start_frame.array()).all());
  if (!(whole.rotation.array() == Matrix3::Identity().array()).all()) {
    const Matrix3 turned = turned_since(start_frame, s.cell());
    s.turn(turned.transpose() * whole.rotation * turned);
  }
  return report;
}

Report load_rotation(State& s, const FrameSplit& increment, const Matrix3& dh) {
  Report report;
  const SolverState& control = s.control();
  // The path that led here is what is judged, as it was at its end; a rotation adds nothing.
  const bool known = control.quasi_static && control.steps_since_scaling >= 0;
  report.unbalanced_ratio = known ? control.unbalanced_ratio : s.unbalanced_ratio(s.out_of_balance());
  const double of_start = factor_of_last_start(s);
  judge_equilibrium(s, report, of_start > 0 ? report.unbalanced_ratio : 0);
  const double more = s.has_deferred() ? extrapolated(s, control.deferred_stretch).error : 0.0;
  Judged judged{0, report.unbalanced_ratio, 0, more};
  judged.factor_from_rest = of_start;
  estimate_error(s, network_change(s, control.strain_since_reversal), s.stress(), judged, report);
  if (dh.isZero(0)) return report;
  const Matrix3 turned = (Matrix3::Identity() + dh) * s.cell().rotation;
  const bool quarter_turn = (dh + Matrix3::Identity()).unaryExpr([](double x) { return x * x * x - x; }).isZero(0);
  s.turn(increment.rotation);
  if (quarter_turn) s.set_rotation(turned);  // rows change places, no bit of them is lost
  return report;
}

long make_deferred(State& s) {
  if (!s.has_deferred()) return 0;
  const FrameSplit deferred{Matrix3::Identity(), s.control().deferred_stretch, false};
  s.set_deferred(Matrix3::Identity());
  return load_quasi_static(s, deferred).substeps;
}

}  // namespace rvelab
