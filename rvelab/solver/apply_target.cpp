// apply with a mixed target: the stress servo runs inside the sub-steps. At dt = 0 the pace follows the unbalanced
// ratio and the end of the increment waits for the stress; at dt > 0 the increment takes the time that was given, no
// more. Declared in rve_impl.hpp.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "rvelab/cell/volume.hpp"
#include "rvelab/error.hpp"
#include "rvelab/solver/loading/collisions.hpp"
#include "rvelab/solver/loading/servo.hpp"
#include "rvelab/solver/rve_impl.hpp"

namespace rvelab {

namespace {

constexpr long servo_interval = 5;  ///< sub-steps between control updates of the servo

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

}  // namespace

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
  double strain = 0;

  TargetPath path{target, fixture.dimension()};
  double fraction = 0, since_control = 0;
  long waited = 0, longest_wait = target.wait;
  bool arrived = false, looked = false;
  while (true) {
    if (since_control == 0)
      servo.set_stiffness(affine_stiffness(fixture, now), soft_stiffness(fixture, now, least_stiffness(fixture, now)));
    long steps = servo_interval;
    const double wanted = servo.predicted_strain() + target.spin.norm();
    if (report.substeps == 0) {
      strain = servo.predicted_strain();
      set_pace_target(target_of_held_path());
    }
    const double full_pace = double(servo_interval) * now.state.strain_per_step;
    double advance_by = wanted > 0 ? std::min(1 - fraction, full_pace / wanted) : 1 - fraction;
    const bool waiting = fraction >= 1;
    if (waiting) {
      // In stiff packings the increment itself takes thousands of sub-steps, and what it stirs up calms as slowly.
      if (waited == 0) longest_wait = std::max(target.wait, report.substeps / 4);
      if (!servo.controls_stress() || waited >= longest_wait) break;
      steps = std::min(steps, longest_wait - waited);
      advance_by = 0;
    }
    fraction = 1 - fraction - advance_by < 1e-12 ? 1.0 : fraction + advance_by;
    const Matrix3 change =
        servo.next_strain(fraction, advance_by * wanted, full_pace, path.strain, stress(), now.state.servo_strain);
    advance(fixture, now,
            loading_of(fixture, split_increment(now.cell, path.go_on(change, fraction)), steps, 1, false, false));
    moved();
    looked = false;
    now.state.interval_strain += change.norm();
    report.substeps += steps;
    if (report.substeps > fixture.options.max_substeps)
      throw IncrementFailed("the increment needs more than " + std::to_string(fixture.options.max_substeps) +
                            " sub-steps (solver.max_substeps)");
    if (waiting) waited += steps;
    since_control += double(steps);
    if (since_control >= double(control_interval)) {
      since_control = 0;
      const Balance balance = look();
      looked = true;
      if (!waiting) steer_pace(balance, servo.held_stress());
    }
    // The pace is judged before the wait, whose calm says nothing of it.
    if (fraction >= 1 && !arrived) {
      arrived = true;
      if (!looked && end_is_looked_at(report.substeps, strain)) {
        steer_pace(look(), servo.held_stress());
        looked = true;
      }
    }
    if (fraction >= 1) {
      report.held_error = servo.held_error(path.strain, stress());
      if (report.held_error <= target.tolerance) break;
    }
  }
  if (!looked && end_is_looked_at(report.substeps, strain)) look();
  report.unbalanced_ratio = now.state.unbalanced_ratio;
  report.held_error = servo.held_error(path.strain, stress());
  report.target_held = report.held_error <= target.tolerance;
  judge(report);
  judge_error(tolerance_of_held_path() * pressure_scale(), strain, report.unbalanced_ratio, 0, report);
  gradient = path.gradient;
  return report;
}

}  // namespace rvelab
