// apply with a mixed target: the stress servo runs inside the sub-steps. At dt = 0 the pace follows the unbalanced
// ratio, and the target waits for a stress that the grains let go (loading/recovery.hpp); at dt > 0 the increment takes
// the time that was given, no more. Declared in rve_impl.hpp.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "rvelab/cell/volume.hpp"
#include "rvelab/error.hpp"
#include "rvelab/solver/loading/collisions.hpp"
#include "rvelab/solver/loading/recovery.hpp"
#include "rvelab/solver/loading/servo.hpp"
#include "rvelab/solver/rve_impl.hpp"

namespace rvelab {

namespace {

constexpr long servo_interval = 5;      ///< sub-steps between control updates of the servo
constexpr long recovery_interval = 10;  ///< those between looks at contacts that form anew

/// What keeps the gain regular in a gas, Pa: a hundredth of what one typical contact per grain would give, from the
/// bound of stiffness of a grain of two (N/m).
double soft_stiffness(const Fixture& f, const Assembly& a, double floor) {
  const double spacing = f.dimension() == 2 ? a.cell.lattice(2, 2) : 2 * f.mean_radius;
  return 0.01 * floor / spacing;
}

/// Strain and gradient of a mixed target so far, and the way from one control update to the next.
struct TargetPath {
  const MixedTarget& target;
  int dimension;
  Matrix3 strain = Matrix3::Zero(), gradient = Matrix3::Zero();

  /// Adds a strain; returns the increment, relative to the present configuration, that brings the gradient there.
  Matrix3 go_on(const Matrix3& change, double fraction) {
    const Matrix3 identity = Matrix3::Identity(), from = gradient;
    strain += change;
    gradient = strain + fraction * target.spin;
    if (target.volume_ratio > 0) {
      gradient = with_volume_ratio(gradient, 1 + fraction * (target.volume_ratio - 1), dimension);
      strain = 0.5 * (gradient + gradient.transpose());
    }
    return (identity + gradient) * (identity + from).inverse() - identity;
  }
};

IncrementFailed too_many_substeps(const Report& report, long most) {
  return IncrementFailed("the increment needs more than " + std::to_string(most) +
                         " sub-steps (solver.max_substeps); the held stress is off by " + in_words(report.held_error) +
                         " of its scale");
}

}  // namespace

double Rve::Impl::strain_of_held(const Servo& servo) const {
  // p = f N d/V for some four contacts a grain in the plane, six in space.
  const double diameter = 2 * fixture.mean_radius;
  const double force = servo.held_stress() * now.cell.volume() / (double(fixture.size()) * diameter);
  const double share = std::clamp(force / now.state.reference_contact_force, 1e-7, 1.0);
  return share * now.state.reference_overlap / diameter;
}

Report Rve::Impl::load(const MixedTarget& target, double dt, Matrix3& gradient) {
  return dt > 0 ? load_at_rate(target, dt, gradient) : load_quasi_static(target, gradient);
}

Report Rve::Impl::load_at_rate(const MixedTarget& target, double dt, Matrix3& gradient) {
  Report report;
  const auto stress = [&]() -> Matrix3 { return to_lab(present_stress()) + reynolds_stress(); };
  Servo servo(target, fixture.dimension(), stress(), Servo::Missed::at_once);
  begin_loading(fixture, now, Loading::physical);

  TargetPath path{target, fixture.dimension()};
  Vector6 mean_residual = Vector6::Zero();
  double fraction = 0, gain_time = 0;
  long since_look = 0;
  TimeStep time_step;
  Matrix6 viscosity;
  while (fraction < 1) {
    if (since_look >= time_step.interval) {
      since_look = 0;
      checked_balance();
      time_step = this->time_step(now.state.last_rate, control_interval, (1 - fraction) * dt);
      servo.set_stiffness(affine_stiffness(fixture, now),
                          soft_stiffness(fixture, now, present_sums().floor_translation));
      viscosity = affine_viscosity(fixture, now);
      gain_time = 0;
    }
    const double count = std::max(1.0, std::ceil((1 - fraction) * dt / time_step.longest * (1 - 1e-9)));
    if (double(report.substeps) + count > double(fixture.options.max_substeps))
      throw IncrementFailed("the increment needs more than " + std::to_string(fixture.options.max_substeps) +
                            " sub-steps (solver.max_substeps)");
    const long steps = long(std::min(double(servo_interval), count));
    const double step = (1 - fraction) * dt / count, time = double(steps) * step;
    if (std::abs(time - gain_time) > 0.1 * gain_time) {
      servo.set_viscosity(viscosity, time);
      gain_time = time;
    }
    const double wanted = servo.predicted_strain() + target.spin.norm();
    const double advance_by = double(steps) == count ? 1 - fraction : (1 - fraction) * double(steps) / count;
    const double full_pace = std::max(wanted * time / dt, 1e-9);
    const double limit = 10 * full_pace;
    fraction = double(steps) == count ? 1.0 : fraction + advance_by;
    const Matrix3 change = servo.next_strain_at_rate(fraction, advance_by * wanted, full_pace, limit, path.strain,
                                                     stress(), now.state.servo_rate, now.state.servo_strain);
    now.state.servo_rate = change / time;
    const Advanced made = advance(fixture, now,
                                  loading_of(fixture, split_increment(now.cell, path.go_on(change, fraction)), steps,
                                             step, true, time_step.deep));
    moved();
    report.substeps += made.steps;
    since_look += made.step < 0.999 * step ? time_step.interval : made.steps;
    mean_residual += advance_by * servo.residual(fraction, path.strain, stress());
  }
  gradient = path.gradient;
  report.unbalanced_ratio = unbalanced(checked_balance());
  report.held_error = servo.largest_error(mean_residual);
  report.target_held = report.held_error <= target.tolerance;
  return report;
}

Report Rve::Impl::load_quasi_static(const MixedTarget& target, Matrix3& gradient) {
  Report report;
  const auto stress = [&]() -> Matrix3 { return to_lab(present_stress()) + reynolds_stress(); };
  Servo servo(target, fixture.dimension(), stress(), Servo::Missed::evenly);
  begin_quasi_static();
  TargetPath path{target, fixture.dimension()};
  Recovery recovery(target, strain_of_held(servo), fixture.dimension());
  double fraction = 0, strain = 0;
  long since_control = 0;
  bool looked = false;
  while (true) {
    report.held_error = servo.largest_error(servo.residual(fraction, path.strain, stress()));
    if (fraction >= 1 && report.held_error <= target.tolerance) break;
    recovery.judge(report.held_error);
    if (since_control == 0)
      servo.set_stiffness(affine_stiffness(fixture, now), soft_stiffness(fixture, now, least_stiffness(fixture, now)));
    const double wanted = servo.predicted_strain() + target.spin.norm();
    if (report.substeps == 0) {
      strain = servo.predicted_strain();
      set_pace_target(target_of_held_path());
    }
    const bool waiting = fraction >= 1 || recovery.under_way();
    const long steps = waiting ? std::min(servo_interval, recovery.patience(report.substeps)) : servo_interval;
    if (steps <= 0) break;
    const double full_pace = double(servo_interval) * now.state.strain_per_step, left = 1 - fraction;
    const double advance_by = waiting ? 0.0 : wanted > 0 ? std::min(left, full_pace / wanted) : left;
    const double closing = recovery.under_way() ? double(servo_interval) * recovery.pace() : 0.0;
    fraction = left - advance_by < 1e-12 ? 1.0 : fraction + advance_by;
    const Matrix3 change =
        servo.next_strain(fraction, advance_by * wanted, full_pace, std::max(10 * full_pace, closing), path.strain,
                          stress(), now.state.servo_strain);
    const FrameSplit increment = split_increment(now.cell, path.go_on(change, fraction));
    advance(fixture, now, loading_of(fixture, increment, steps, 1, false, false));
    moved();
    now.state.interval_strain += change.norm();
    report.substeps += steps;
    since_control += steps;
    if (waiting) recovery.waited(steps, change);
    if (report.substeps > fixture.options.max_substeps) throw too_many_substeps(report, fixture.options.max_substeps);
    const bool arrived = !waiting && fraction >= 1;
    const bool due = since_control >= (recovery.under_way() ? recovery_interval : control_interval);
    if (due) since_control = 0;
    looked = due || (arrived && end_is_looked_at(report.substeps, strain));
    if (!looked) continue;
    const Balance balance = look();
    // The pace is judged before a wait, whose calm says nothing of it.
    if (!waiting) steer_pace(balance, servo.held_stress());
    recovery.looked(2 * double(balance.touching) / double(fixture.size()), change);
  }
  if (!looked && end_is_looked_at(report.substeps, strain)) look();
  report.waited = recovery.substeps();
  report.target_held = report.held_error <= target.tolerance;
  report.unbalanced_ratio = now.state.unbalanced_ratio;
  judge(report);
  judge_error(tolerance_of_held_path() * pressure_scale(), strain, report.unbalanced_ratio, 0, report);
  gradient = path.gradient;
  return report;
}

}  // namespace rvelab
