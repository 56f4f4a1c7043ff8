// A mixed target in quasi-static loading: the servo runs inside the sub-steps, the strain per step follows the
// unbalanced ratio, and the target waits for a stress that the grains let go (recovery.hpp). Declared in
// quasi_static.hpp.
#include <algorithm>
#include <string>

#include "rvelab/error.hpp"
#include "rvelab/solver/assembly/interactions.hpp"
#include "rvelab/solver/quasi_static/check.hpp"
#include "rvelab/solver/quasi_static/error_model.hpp"
#include "rvelab/solver/quasi_static/events.hpp"
#include "rvelab/solver/quasi_static/quasi_static.hpp"
#include "rvelab/solver/quasi_static/recovery.hpp"
#include "rvelab/solver/quasi_static/servo.hpp"
#include "rvelab/solver/quasi_static/strain_step.hpp"
#include "rvelab/solver/quasi_static/target_path.hpp"

namespace rvelab {

using namespace constants;

namespace {

/// Strain that the overlaps of grains which carry the held stress are worth.
double strain_of_held(const State& state, const Servo& servo) {
  // p = f N d/V for some four contacts a grain in the plane, six in space.
  const double diameter = 2 * state.model().mean_radius;
  const double force = servo.held_stress() * state.cell().volume() / (double(state.model().size()) * diameter);
  const double share = std::clamp(force / state.reference().contact_force, least_held_force, 1.0);
  return share * state.reference().overlap / diameter;
}

/// A mixed target on its way.
class StressControl {
 public:
  StressControl(State& state, const MixedTarget& target)
      : state_(state),
        target_(target),
        servo_(target, state.model().dimension(), stress(), Servo::Missed::evenly),
        check_(state),
        path_{target, state.model().dimension()},
        recovery_(target, strain_of_held(state, servo_), state.model().dimension()),
        events_(state) {}

  Report make(Matrix3& gradient);

 private:
  Matrix3 stress() { return state_.to_lab(state_.stress()) + state_.reynolds_stress(); }
  /// The servo's strain of some sub-steps, and that of the target beside.
  Matrix3 next_strain(bool waiting);
  void expect_substeps() const;
  /// Checks where it is due, and lets the strain per step follow.
  void check(bool waiting, const Matrix3& change);
  Report judged();

  State& state_;
  const MixedTarget& target_;
  Servo servo_;
  EquilibriumCheck check_;
  TargetPath path_;
  Recovery recovery_;
  InteractionEvents events_;
  Report report_;
  double fraction_ = 0, strain_ = 0;  ///< of the target; expected of the whole
  long since_update_ = 0;             ///< sub-steps since the gain was renewed
  bool checked_ = false;
};

Matrix3 StressControl::next_strain(bool waiting) {
  const double wanted = servo_.predicted_strain() + target_.spin.norm();
  const double full = double(servo_interval) * state_.control().strain_per_step, left = 1 - fraction_;
  const double advance_by = waiting ? 0.0 : wanted > 0 ? std::min(left, full / wanted) : left;
  const double closing = recovery_.under_way() ? double(servo_interval) * recovery_.closing() : 0.0;
  fraction_ = left - advance_by < 1e-12 ? 1.0 : fraction_ + advance_by;
  return servo_.next_strain(fraction_, advance_by * wanted, full, std::max(largest_answer * full, closing),
                            path_.strain, stress(), state_.servo().strain);
}

void StressControl::expect_substeps() const {
  const long most = state_.model().options.max_substeps;
  if (report_.substeps <= most) return;
  throw IncrementFailed("the increment needs more than " + std::to_string(most) +
                        " sub-steps (solver.max_substeps); the held stress is off by " + in_words(report_.held_error) +
                        " of its scale");
}

void StressControl::check(bool waiting, const Matrix3& change) {
  const bool arrived = !waiting && fraction_ >= 1;
  const bool due = since_update_ >= (recovery_.under_way() ? 2 * servo_interval : check_interval);
  if (due) since_update_ = 0;
  checked_ = due || (arrived && check_.is_due_at_end(report_.substeps, strain_));
  if (!checked_) return;
  const OutOfBalance balance = check_.check();
  // The strain per step is judged before a wait, in which the ratio says nothing of it.
  if (!waiting) adapt_strain_step(state_, balance, servo_.held_stress());
  double joined = double(balance.touching);
  // Grains that bonds join bear a stress though none touches another. Counted where few do: it walks over all of them.
  if (2 * joined < contacts_apart * double(state_.model().size()) && has_interactions(state_.assembly()))
    joined += double(acting_interactions(state_.model(), state_.assembly()).size());
  recovery_.checked(2 * joined / double(state_.model().size()), change);
}

Report StressControl::judged() {
  report_.waited = recovery_.substeps();
  report_.target_held = report_.held_error <= target_.tolerance;
  report_.unbalanced_ratio = state_.control().unbalanced_ratio;
  judge_equilibrium(state_, report_);
  estimate_error(state_, held_tolerance(state_) * pressure_scale(state_),
                 {.strain = strain_,
                  .unbalanced_ratio = report_.unbalanced_ratio,
                  .events = events_.happened(state_),
                  .broken_stress = events_.broken_stress(state_)},
                 report_);
  return report_;
}

Report StressControl::make(Matrix3& gradient) {
  check_.prepare();
  while (true) {
    report_.held_error = servo_.largest_error(servo_.residual(fraction_, path_.strain, stress()));
    if (fraction_ >= 1 && report_.held_error <= target_.tolerance) break;
    recovery_.judge(report_.held_error);
    if (since_update_ == 0)
      servo_.set_stiffness(
          affine_stiffness(state_.model(), state_.assembly()),
          gas_stiffness(state_.model(), state_.cell(), least_stiffness(state_.model(), state_.assembly())));
    if (report_.substeps == 0) {
      strain_ = servo_.predicted_strain();
      set_target_ratio(state_, held_target_ratio(state_));
    }
    const bool waiting = fraction_ >= 1 || recovery_.under_way();
    const long steps = waiting ? std::min(servo_interval, recovery_.patience(report_.substeps)) : servo_interval;
    if (steps <= 0) break;
    const Matrix3 change = next_strain(waiting);
    state_.advance({split_increment(state_.cell(), path_.go_on(change, fraction_)), steps, 1, Loading::quasi_static});
    state_.control().interval.strain += change.norm();
    report_.substeps += steps;
    since_update_ += steps;
    if (waiting) recovery_.waited(steps, change);
    expect_substeps();
    check(waiting, change);
  }
  if (!checked_ && (check_.is_due_at_end(report_.substeps, strain_) || events_.happened(state_))) check_.check();
  gradient = path_.gradient;
  return judged();
}

}  // namespace

Report follow_target_quasi_static(State& state, const MixedTarget& target, Matrix3& gradient) {
  return StressControl(state, target).make(gradient);
}

}  // namespace rvelab
