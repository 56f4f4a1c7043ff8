#include "rvelab/solver/quasi_static/quasi_static.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "rvelab/error.hpp"
#include "rvelab/solver/assembly/contact_states.hpp"
#include "rvelab/solver/loading/strain_path.hpp"
#include "rvelab/solver/quasi_static/check.hpp"
#include "rvelab/solver/quasi_static/constants.hpp"
#include "rvelab/solver/quasi_static/deferred.hpp"
#include "rvelab/solver/quasi_static/error_model.hpp"
#include "rvelab/solver/quasi_static/events.hpp"
#include "rvelab/solver/quasi_static/relaxation.hpp"
#include "rvelab/solver/quasi_static/strain_step.hpp"

namespace rvelab {

using namespace constants;

namespace {

/// The network is elastic again after a reversal, and velocities that go the other way are worse than none: carried on
/// they left ten times the error.
void turn_back(State& state) {
  QuasiStaticControl& control = state.control();
  state.stop_quasi_static();
  state.last_step().rate.setZero();
  control.stiffness_ratio = 1;
  control.interval.strain = 0;
  control.interval.stress = state.stress();
}

/// The sub-steps of an increment, and what its checks find.
class CheckedSteps {
 public:
  CheckedSteps(State& state, EquilibriumCheck& check, const StrainPath& path, const StartUp& start)
      : state_(state),
        check_(check),
        path_(path),
        strain_(path.strain()),
        most_(most_substeps(state, strain_)),
        fewest_(std::min(start.substeps, most_)),
        from_rest_(start.start_error_factor > 0),
        events_(state) {}

  /// Makes them; `substeps` were made before and counts on.
  void make(long& substeps) {
    const Matrix3 start_frame = state_.cell().rotation;
    Matrix3 done = Matrix3::Identity();
    while (fraction_ < 1) {
      const long steps = choose(substeps);
      const Matrix3 next = path_.at(fraction_);
      Advance part{next_part(start_frame, state_.cell(), done, next), steps};
      if (from_rest_) {
        part.step = std::max(1.0, start_step / state_.model().options.time_step_factor);
        part.damping = start_damping;
      }
      state_.advance(part);
      done = next;
      substeps += steps;
      state_.control().interval.strain += (fraction_ - before_) * strain_;
      end_is_checked_ =
          fraction_ == 1 ? check_.is_due_at_end(substeps, strain_) || events_.happened(state_) : check_.is_due();
      if (end_is_checked_) check();
    }
  }
  bool end_is_checked() const { return end_is_checked_; }
  const InteractionEvents& events() const { return events_; }
  /// Root of the sum of squares of the lags that the checks before the end found, Pa.
  double path_lag() const { return std::sqrt(squares_); }

 private:
  /// Sub-steps until the next check; moves the fraction on.
  long choose(long made) {
    const SolverOptions& o = state_.model().options;
    double& strain_per_step = state_.control().strain_per_step;
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
      steps_left = long(std::clamp(std::max(count, at_least), 1.0, constants::most_steps_counted));
      by_strain_ = count >= at_least;
    }
    const bool hopeless = left * strain_ / step_of_gas > double(o.max_substeps);
    const bool settled = !by_strain_ || hopeless || made >= settling_steps;
    expect_substeps(state_, made + (settled ? steps_left : 1));
    const long steps = steps_left <= check_interval + check_interval / 2 ? steps_left : check_interval;
    before_ = fraction_;
    fraction_ = steps == steps_left ? 1.0 : fraction_ + left * double(steps) / double(steps_left);
    return steps;
  }

  void check() {
    const OutOfBalance balance = check_.check();
    if (fraction_ < 1) {
      const double lag = expected_error(state_, state_.control().unbalanced_ratio);
      squares_ += lag * lag;
    }
    if (from_rest_) return;
    // Where the fewest steps rule, their strain is not that of the control, but it may still be found too large.
    const bool too_fast = state_.control().unbalanced_ratio > state_.control().target_unbalanced_ratio;
    if (state_.model().options.fixed_substeps == 0 && (by_strain_ || too_fast)) adapt_strain_step(state_, balance);
    // The transient has decayed: allow fewer sub-steps, where contacts stay what they are.
    constexpr double few = 2 * double(check_interval);
    const double left = 1 - before_;
    if (strain_ < overlap_strain(state_) && !too_fast && left * fewest_ > few)
      fewest_ = std::max(fewer_after_check * fewest_, few / left);
  }

  State& state_;
  EquilibriumCheck& check_;
  const StrainPath& path_;
  double strain_, most_, fewest_;
  bool from_rest_;
  InteractionEvents events_;
  double fraction_ = 0, before_ = 0, squares_ = 0;
  bool by_strain_ = true;  ///< the strain per step decides their number
  bool end_is_checked_ = false;
};

void take_in_deferred(State& state, FrameSplit& increment) {
  if (!state.has_deferred()) return;
  increment.stretch = (increment.stretch * state.control().deferred.stretch).eval();
  state.set_deferred(Matrix3::Identity());
}

/// Of an increment against the rate of strain of the last sub-step.
struct TurnOfPath {
  bool starts_again;  ///< no component along it, as after a stop
  bool reverses;      ///< a component against it
};
TurnOfPath turn_of(const Matrix3& change, const Matrix3& rate) {
  const double along = rate.cwiseProduct(change).sum();
  return {along <= 0, along < 0};
}

/// What an increment finds done before its first sub-step.
struct Prepared {
  EquilibriumCheck check;
  TurnOfPath turn;
  Relaxed relaxed;
};
Prepared prepare_increment(State& state, const Matrix3& change, double strain, TrialCaching caching) {
  const bool cached = caching == TrialCaching::on && by_tolerance(state);
  if (cached && state.has_trial_cache()) {
    CachedRelaxation& made = state.cached_relaxation();
    const TurnOfPath turn = turn_of(change, made.rate);
    if (relaxes_alike(state.model().options, made, strain, turn.reverses)) {
      state.take_trial_cache();
      state.count_shared(substeps_of(made));
      return {EquilibriumCheck(state, made.not_yet_checked), turn, relaxed_by(state, made)};
    }
  }
  Prepared prepared{EquilibriumCheck(state), {}, {}};
  prepared.check.prepare();
  prepared.turn = turn_of(change, state.last_step().rate);
  if (!by_tolerance(state)) return prepared;
  // Masses that were scaled again want a check. Where grains are held firmly and forces are what they will be, it is
  // one of the state that trials share: at the end of each it was two fifths of a trial of 1e-6 from rest (114,000 of
  // 300,000 instructions), and of 547 starts from rest 97.3 % were within their estimate, as 97.1 % are so.
  const bool masses_scaled = prepared.check.not_yet_checked();
  if (masses_scaled && error_factor_of_start(state) <= firm_error_factor &&
      !holds_more_than_friction(state.model(), state.assembly()))
    prepared.check.check();
  CachedRelaxation relaxation = inputs_of_relaxation(state);
  prepared.relaxed = relax_before(state, prepared.check, strain, prepared.turn.reverses, relaxation);
  relaxation.not_yet_checked = prepared.check.not_yet_checked();
  // The longest that was made stays: it is worth most.
  const bool worth = relaxation.parts() > 0 || masses_scaled;
  if (cached && worth && !(state.has_trial_cache() && state.cached_relaxation().parts() >= relaxation.parts()))
    state.keep_trial_cache(std::move(relaxation));
  return prepared;
}

/// Notes a turn of the path, before the increment that makes it.
void note_direction(State& state, double strain, const TurnOfPath& turn) {
  QuasiStaticControl& control = state.control();
  if (turn.starts_again) control.strain_since_reversal = 0;
  control.strain_since_reversal = std::min(control.strain_since_reversal + strain, judged_together);
  if (by_tolerance(state) && turn.reverses) turn_back(state);
}

}  // namespace

void expect_substeps(const State& state, long needed) {
  if (needed <= state.model().options.max_substeps) return;
  throw IncrementFailed("the increment needs " + std::to_string(needed) + " sub-steps; solver.max_substeps allows " +
                        std::to_string(state.model().options.max_substeps));
}

Report load_quasi_static(State& state, FrameSplit whole, TrialCaching caching) {
  Report report;
  QuasiStaticControl& control = state.control();
  take_in_deferred(state, whole);
  const Matrix3 start_frame = state.cell().rotation, change = whole.stretch - Matrix3::Identity();
  const StrainPath path(whole, false);
  const double strain = path.strain();
  Prepared prepared = prepare_increment(state, change, strain, caching);
  const TurnOfPath turn = prepared.turn;
  report.substeps += prepared.relaxed.steps;
  const Matrix3 stress_before = state.stress();
  note_direction(state, strain, turn);

  const double elastic_change = elastic_stress_change(state, std::max(strain, control.strain_since_reversal));
  set_target_ratio(state, target_ratio(state, elastic_change));
  const StartUp start = start_up_of(state, change, strain, elastic_change, turn.reverses);
  CheckedSteps substeps(state, prepared.check, path, start);
  substeps.make(report.substeps);
  if (!state.stress().allFinite())
    throw IncrementFailed("the increment led to values that are not finite; apply it in smaller parts");

  // Between checks the ratio that is expected of a start is used.
  if (!substeps.end_is_checked()) control.unbalanced_ratio = std::max(start.unbalanced_ratio, control.unbalanced_ratio);
  report.unbalanced_ratio = control.unbalanced_ratio;
  judge_equilibrium(state, report, start.start_error_factor > 0 ? start.unbalanced_ratio : 0);
  const JudgedIncrement judged{.strain = strain,
                               .unbalanced_ratio = control.unbalanced_ratio,
                               .creep_error = prepared.relaxed.creep,
                               .start_error_factor = start.start_error_factor,
                               .events = substeps.events().happened(state),
                               .broken_stress = substeps.events().broken_stress(state)};
  estimate_by_tolerances(state, elastic_change, stress_before, judged, report);
  add_error_of_path(state, strain, substeps.path_lag(), report);
  note_slope(state, whole.stretch, stress_before, (state.cell().rotation.array() == start_frame.array()).all());
  if (!(whole.rotation.array() == Matrix3::Identity().array()).all()) {
    const Matrix3 turned = turned_since(start_frame, state.cell());
    state.turn(turned.transpose() * whole.rotation * turned);
  }
  return report;
}

Report load_rotation(State& state, const FrameSplit& increment, const Matrix3& dh) {
  Report report;
  const QuasiStaticControl& control = state.control();
  // The path that led here is what is judged, as it was at its end; a rotation adds nothing.
  const bool known = state.last_step().loading == Loading::quasi_static && state.masses().in_use;
  report.unbalanced_ratio = known ? control.unbalanced_ratio : state.unbalanced_ratio(state.out_of_balance());
  const double of_start = factor_of_last_start(state);
  judge_equilibrium(state, report, of_start > 0 ? report.unbalanced_ratio : 0);
  const double extrapolation_error = state.has_deferred() ? extrapolated(state, control.deferred.stretch).error : 0.0;
  const JudgedIncrement judged{.unbalanced_ratio = report.unbalanced_ratio,
                               .extrapolation_error = extrapolation_error,
                               .start_error_factor = of_start};
  estimate_by_tolerances(state, elastic_stress_change(state, control.strain_since_reversal), state.stress(), judged,
                         report);
  if (dh.isZero(0)) return report;
  const Matrix3 turned = (Matrix3::Identity() + dh) * state.cell().rotation;
  const bool quarter_turn = (dh + Matrix3::Identity()).unaryExpr([](double x) { return x * x * x - x; }).isZero(0);
  state.turn(increment.rotation);
  if (quarter_turn) state.set_rotation(turned);  // rows change places, no bit of them is lost
  return report;
}

long apply_deferred(State& state) {
  if (!state.has_deferred()) return 0;
  const FrameSplit deferred{Matrix3::Identity(), state.control().deferred.stretch, false};
  state.set_deferred(Matrix3::Identity());
  return load_quasi_static(state, deferred, TrialCaching::off).substeps;
}

}  // namespace rvelab
