#include "rvelab/solver/at_rate/at_rate.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "rvelab/error.hpp"
#include "rvelab/solver/loading/strain_path.hpp"
#include "rvelab/solver/quasi_static/quasi_static.hpp"
#include "rvelab/solver/quasi_static/servo.hpp"
#include "rvelab/solver/quasi_static/target_path.hpp"

namespace rvelab {

namespace {

/// Sub-steps between checks: of an increment, and under stress control, where gains are renewed.
constexpr long rate_check_interval = 100, control_interval = 50;

/// Sub-steps of a time, at most so long each.
double steps_in(double time, double longest) { return std::ceil(time / longest * (1 - 1e-9)); }

Advanced advance_at_rate(State& state, const FrameSplit& increment, long steps, double step, bool deep) {
  return state.advance(
      {increment, steps, step, Loading::at_rate, state.model().options.fixed_time_step == 0, deep ? deep_check : 0});
}

/// A mixed target on its way.
class RateControl {
 public:
  RateControl(State& state, const MixedTarget& target, double dt)
      : state_(state),
        target_(target),
        dt_(dt),
        servo_(target, state.model().dimension(), stress(), Servo::Missed::at_once),
        path_{target, state.model().dimension()} {
    state_.set_loading(Loading::at_rate);
  }

  Report make(Matrix3& gradient);

 private:
  Matrix3 stress() { return state_.to_lab(state_.stress()) + state_.reynolds_stress(); }
  /// Checks, and renews time step and gains.
  void check();
  /// The servo's strain of the next sub-steps, in the time `time` (s); `share` of the target goes with them.
  Matrix3 next_strain(double share, double time);

  State& state_;
  const MixedTarget& target_;
  const double dt_;
  Servo servo_;
  TargetPath path_;
  TimeStep time_step_;
  Matrix6 viscosity_;
  double fraction_ = 0, gain_time_ = 0;
};

void RateControl::check() {
  time_step_ = time_step(state_, state_.last_step().rate, control_interval, (1 - fraction_) * dt_);
  servo_.set_stiffness(affine_stiffness(state_.model(), state_.assembly()),
                       gas_stiffness(state_.model(), state_.cell(), state_.row_sums().floor_translation));
  viscosity_ = affine_viscosity(state_.model(), state_.assembly());
  gain_time_ = 0;
}

Matrix3 RateControl::next_strain(double share, double time) {
  if (std::abs(time - gain_time_) > 0.1 * gain_time_) {
    servo_.set_viscosity(viscosity_, time);
    gain_time_ = time;
  }
  ServoState& servo = state_.servo();
  const double wanted = servo_.predicted_strain() + target_.spin.norm();
  const double full = std::max(wanted * time / dt_, 1e-9);
  const Matrix3 change = servo_.next_strain_at_rate(fraction_, share * wanted, full, constants::largest_answer * full,
                                                    path_.strain, stress(), servo.rate, servo.strain);
  servo.rate = change / time;
  return change;
}

Report RateControl::make(Matrix3& gradient) {
  Report report;
  Vector6 mean_residual = Vector6::Zero();
  long since_check = 0;
  const long most = state_.model().options.max_substeps;
  while (fraction_ < 1) {
    if (since_check >= time_step_.interval) {
      since_check = 0;
      check();
    }
    const double left = 1 - fraction_, count = std::max(1.0, steps_in(left * dt_, time_step_.longest));
    if (double(report.substeps) + count > double(most))
      throw IncrementFailed("the increment needs more than " + std::to_string(most) +
                            " sub-steps (solver.max_substeps)");
    const long steps = long(std::min(double(constants::servo_interval), count));
    const double step = left * dt_ / count;
    const double share = double(steps) == count ? left : left * double(steps) / count;
    fraction_ = double(steps) == count ? 1.0 : fraction_ + share;
    const Matrix3 change = next_strain(share, double(steps) * step);
    const Advanced made = advance_at_rate(state_, split_increment(state_.cell(), path_.go_on(change, fraction_)), steps,
                                          step, time_step_.deep);
    report.substeps += made.steps;
    since_check += made.step < 0.999 * step ? time_step_.interval : made.steps;
    mean_residual += share * servo_.residual(fraction_, path_.strain, stress());
  }
  gradient = path_.gradient;
  report.unbalanced_ratio = state_.unbalanced_ratio(state_.checked_balance());
  report.held_error = servo_.largest_error(mean_residual);
  report.target_held = report.held_error <= target_.tolerance;
  return report;
}

}  // namespace

Report load_at_rate(State& state, const FrameSplit& whole, double dt) {
  Report report;
  state.set_loading(Loading::at_rate);
  state.control().deferred.stress_slope.setZero();
  const Matrix3 start_frame = state.cell().rotation;
  const StrainPath path(whole, true);
  double fraction = 0;
  Matrix3 done = Matrix3::Identity();
  while (fraction < 1) {
    const double left = 1 - fraction;
    const Matrix3 rate =
        report.substeps == 0 ? Matrix3((whole.stretch - Matrix3::Identity()) / dt) : state.last_step().rate;
    const TimeStep limit = time_step(state, rate, rate_check_interval, dt);
    const long steps_left = long(std::clamp(steps_in(left * dt, limit.longest), 1.0, constants::most_steps_counted));
    expect_substeps(state, report.substeps + steps_left);
    const double step = left * dt / double(steps_left);
    const long steps = steps_left <= limit.interval + limit.interval / 2 ? steps_left : limit.interval;
    fraction = steps == steps_left ? 1.0 : fraction + left * double(steps) / double(steps_left);
    const Matrix3 next = path.at(fraction);
    report.substeps +=
        advance_at_rate(state, next_part(start_frame, state.cell(), done, next), steps, step, limit.deep).steps;
    done = next;
  }
  report.unbalanced_ratio = state.unbalanced_ratio(state.checked_balance());
  return report;
}

Report follow_target_at_rate(State& state, const MixedTarget& target, double dt, Matrix3& gradient) {
  return RateControl(state, target, dt).make(gradient);
}

}  // namespace rvelab
