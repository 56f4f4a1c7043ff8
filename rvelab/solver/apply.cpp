// apply: an increment becomes sub-steps. Quasi-static loading picks its pace by the unbalanced-force ratio (measured
// best, performance: nearly free and within a few 1e-4 of the stress); physical loading by the critical step.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "rvelab/cell/volume.hpp"
#include "rvelab/error.hpp"
#include "rvelab/solver/rve_impl.hpp"
#include "rvelab/solver/servo.hpp"

namespace rvelab {

namespace {

constexpr long control_stretch = 50;    ///< sub-steps between looks at the unbalanced ratio
constexpr long physical_stretch = 100;  ///< sub-steps between renewals of the critical step
constexpr long servo_stretch = 5;       ///< sub-steps between strokes of the servo

/// Fewest sub-steps of a quasi-static increment: with fewer the grains cannot leave the affine motion, and the answer
/// is the stiffer affine one (1 % of the stress increment takes 20, measured).
constexpr long fewest_steps = 20;

}  // namespace

Matrix3 rotation_matrix(const Vector3& vector) {
  // exp by halving six times, a short series, and squaring back.
  const Vector3 w = vector / 64;
  const double s = w.squaredNorm();
  const double a = 1 - s / 6 * (1 - s / 20 * (1 - s / 42)), b = 0.5 * (1 - s / 12 * (1 - s / 30 * (1 - s / 56)));
  Matrix3 k;
  k << 0, -w[2], w[1], w[2], 0, -w[0], -w[1], w[0], 0;
  Matrix3 r = Matrix3::Identity() + a * k + b * k * k;
  for (int squaring = 0; squaring < 6; ++squaring) r = Matrix3(r * r);
  return renormalised(r);
}

Balance Rve::Impl::checked_balance() const {
  check_height(fixture, now.cell);  // the list looks too, but only when it is built anew
  const Balance balance = balance_of(fixture, now);
  if (!balance.finite)
    throw IncrementFailed("the increment led to values that are not finite; apply it in smaller parts");
  if (balance.largest_overlap_ratio > fixture.overlap_limit) {
    std::ostringstream text;
    text << "grains overlap by " << balance.largest_overlap_ratio
         << " of the smaller radius; solver.max_overlap_ratio allows " << fixture.overlap_limit
         << "; compress less or take stiffer grains";
    throw IncrementFailed(text.str());
  }
  return balance;
}

double Rve::Impl::initial_pace() const {
  // A thousandth of the mean overlap per diameter and step: the strain that changes contact forces by about as much.
  const double overlap = std::max(balance_of(fixture, now).mean_overlap, 0.1 * now.state.reference_overlap);
  return 1e-3 * overlap / (2 * fixture.mean_radius);
}

double Rve::Impl::unbalanced(const Balance& balance) const {
  return rvelab::unbalanced_ratio(balance, now.state.reference_contact_force);
}

void Rve::Impl::steer_pace(const Balance& balance, double held_stress) {
  // n <- n (unb/target)^0.75 within 0.7 to 1.4 (performance: power 0.7; three quarters needs square roots only).
  const double x = unbalanced(balance) / fixture.options.target_unbalanced;
  const double root = std::sqrt(x);
  const double factor = std::clamp(root * std::sqrt(root), 0.7, 1.4);
  // Never so fast that a step changes the overlaps by more than a hundredth, nor a fiftieth of that slow: where grains
  // flow without a network the ratio stays near one at any pace (a tenth made target_unbalanced below 3e-4 idle).
  // Without contacts 1e-5 of a diameter a step.
  const double overlap = std::max(balance.mean_overlap, 0.1 * now.state.reference_overlap) / (2 * fixture.mean_radius);
  const double fastest = balance.touching > 0 ? 1e-2 * overlap : 1e-5;
  // Where a stress is held far below the specimen's own, the reference would let a step be as large as the overlaps.
  // They are judged by the stress that is asked for: in an avalanche they vanish, and a pace that followed them would
  // make one record cost as much as the whole test (730,000 sub-steps).
  double slowest = 0.02 * fastest;
  if (held_stress > 0 && now.state.reference_pressure > 0 && balance.touching > 0) {
    const double share = std::clamp(held_stress / now.state.reference_pressure, 1e-4, 1.0);
    slowest = std::min(slowest, 0.02 * 1e-2 * share * now.state.reference_overlap / (2 * fixture.mean_radius));
  }
  now.state.strain_per_step = std::clamp(now.state.strain_per_step / factor, slowest, fastest);
}

Report Rve::Impl::load(const Matrix3& dh, double dt) {
  Report report;
  const FrameSplit whole = split_increment(now.cell, dh);
  const bool physical = dt > 0;
  if (!physical && (dh.isZero(0) || whole.rigid)) report.unbalanced_ratio = unbalanced(balance_of(fixture, now));
  if (!physical && (dh.isZero(0))) return report;
  if (!physical && whole.rigid) {
    const Matrix3 turned = (Matrix3::Identity() + dh) * now.cell.rotation;
    const bool quarter_turn = (dh + Matrix3::Identity()).unaryExpr([](double x) { return x * x * x - x; }).isZero(0);
    turn_frame(now.cell, whole.rotation);
    if (quarter_turn) now.cell.rotation = turned;  // rows change places, no bit of them is lost
    return report;
  }
  begin_loading(fixture, now, physical ? Loading::physical : Loading::quasi_static);
  const Matrix3 identity = Matrix3::Identity(), start_frame = now.cell.rotation;
  // The part of the increment done at fraction s, in the frame of the start (where quarter turns change no bit of it):
  // straight in the stretch, geodesic in the rotation (at dt = 0 the frame turns at the end, since nothing depends on
  // when).
  const Vector3 turn = physical ? rotation_vector(whole.rotation) : Vector3::Zero();
  const bool turns = physical && !(whole.rotation.array() == identity.array()).all();
  const auto done_at = [&](double s) -> Matrix3 {
    const Matrix3 stretch = s == 1 ? whole.stretch : Matrix3(identity + s * (whole.stretch - identity));
    const Matrix3 rotation = !turns ? identity : (s == 1 ? whole.rotation : rotation_matrix(s * turn));
    return rotation * stretch;
  };
  // How the frame has turned since the start; orthogonal to round-off, so that no error of Q feeds on itself.
  const auto turned_since_start = [&]() -> Matrix3 {
    if ((now.cell.rotation.array() == start_frame.array()).all()) return identity;
    return renormalised(start_frame.transpose() * now.cell.rotation);
  };
  // Green's strain: the pace must not depend on the frame, as the norm of a triangular stretch does.
  const double strain = 0.5 * (whole.stretch.transpose() * whole.stretch - identity).norm();
  if (!physical && now.state.strain_per_step == 0) now.state.strain_per_step = initial_pace();

  double fraction = 0;
  Matrix3 done = identity;
  RowSums sums;
  while (fraction < 1) {
    if (physical) sums = row_sums(fixture, now);
    const double left = 1 - fraction;
    double step = 1;
    long steps_left, stretch;
    bool paced = true;
    if (physical) {
      double longest = fixture.options.fixed_time_step;
      if (longest <= 0) longest = fixture.options.time_step_factor * critical_step(fixture, with_floor(sums, fixture));
      const double count = std::ceil(left * dt / longest * (1 - 1e-9));
      steps_left = long(std::clamp(count, 1.0, 1e15));
      step = left * dt / double(steps_left);
      stretch = physical_stretch;
    } else if (fixture.options.fixed_substeps > 0) {
      steps_left = std::max(1L, std::lround(left * double(fixture.options.fixed_substeps)));
      stretch = control_stretch;
      paced = false;
    } else {
      const double count = std::ceil(left * strain / now.state.strain_per_step);
      const double fewest = std::ceil(left * double(fewest_steps));
      steps_left = long(std::clamp(std::max(count, fewest), 1.0, 1e15));
      paced = count >= fewest;
      stretch = control_stretch;
    }
    if (report.substeps + steps_left > fixture.options.max_substeps)
      throw IncrementFailed("the increment needs " + std::to_string(report.substeps + steps_left) +
                            " sub-steps; solver.max_substeps allows " + std::to_string(fixture.options.max_substeps));
    const long steps = steps_left <= stretch + stretch / 2 ? steps_left : stretch;
    fraction = steps == steps_left ? 1.0 : fraction + left * double(steps) / double(steps_left);
    const Matrix3 next = done_at(fraction);
    const Matrix3 part = next * done.inverse();
    Cell since_start = now.cell;
    since_start.rotation = turned_since_start();
    advance(fixture, now,
            {split_increment(since_start, part - identity), steps, step,
             physical ? Loading::physical : Loading::quasi_static});
    done = next;
    report.substeps += steps;
    const Balance balance = checked_balance();
    report.unbalanced_ratio = unbalanced(balance);
    if (physical) continue;
    sums = row_sums(fixture, now);
    // Where the fewest steps rule, the pace is not that of these steps, but it may still be found too fast.
    const bool too_fast = report.unbalanced_ratio > fixture.options.target_unbalanced;
    if (paced || (too_fast && fixture.options.fixed_substeps == 0)) steer_pace(balance);
    if (inertia_outgrown(fixture, sums, now)) rescale_inertia(fixture, sums, now);
  }
  if (!physical && fixture.options.ledger) rescale_inertia(fixture, sums, now);
  if (!physical && !(whole.rotation.array() == identity.array()).all()) {
    const Matrix3 turned = turned_since_start();
    turn_frame(now.cell, turned.transpose() * whole.rotation * turned);
  }
  return report;
}

Report Rve::Impl::load(const MixedTarget& target, double dt, Matrix3& gradient) {
  Report report;
  const bool physical = dt > 0;
  const Matrix3 identity = Matrix3::Identity();
  const auto stress = [&]() -> Matrix3 { return contact_stress() + reynolds_stress(); };
  Servo servo(target, fixture.dimension(), stress());
  begin_loading(fixture, now, physical ? Loading::physical : Loading::quasi_static);
  if (!physical && now.state.strain_per_step == 0) now.state.strain_per_step = initial_pace();

  Matrix3 strain = Matrix3::Zero();
  double fraction = 0, since_control = 0;
  long waited = 0, longest_wait = target.wait;
  RowSums sums = row_sums(fixture, now);
  double soft = 0;
  bool arrived = false;
  while (true) {
    if (since_control == 0) {
      // A hundredth of what one typical contact per grain would give keeps the gain regular in a gas.
      const double spacing = fixture.dimension() == 2 ? now.cell.lattice(2, 2) : 2 * fixture.mean_radius;
      soft = 0.01 * sums.floor_translation / spacing;
      servo.set_stiffness(affine_stiffness(fixture, now), soft);
    }
    double step = 1;
    long steps = servo_stretch;
    double advance_by = 0, full_pace;
    const double wanted = servo.predicted_strain() + target.spin.norm();
    if (physical) {
      double longest = fixture.options.fixed_time_step;
      if (longest <= 0) longest = fixture.options.time_step_factor * critical_step(fixture, with_floor(sums, fixture));
      const double left = (1 - fraction) * dt;
      if (fraction < 1) {
        const double count = std::max(1.0, std::ceil(left / longest * (1 - 1e-9)));
        steps = long(std::min(double(servo_stretch), count));
        step = left / count;
        advance_by = (1 - fraction) * double(steps) / count;
      } else {
        step = longest;
      }
      full_pace = std::max(wanted * double(steps) * step / dt, 1e-9);
    } else {
      const double reach = double(servo_stretch) * now.state.strain_per_step;
      advance_by = wanted > 0 ? std::min(1 - fraction, reach / wanted) : 1 - fraction;
      full_pace = reach;
    }
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
        servo.next_strain(fraction, advance_by * wanted, full_pace, strain, stress(), now.state.servo_strain);
    const Matrix3 from = gradient;
    strain += change;
    gradient = strain + fraction * target.spin;
    if (target.volume_ratio > 0) {
      gradient = with_volume_ratio(gradient, 1 + fraction * (target.volume_ratio - 1), fixture.dimension());
      strain = 0.5 * (gradient + gradient.transpose());
    }
    const Matrix3 part = (identity + gradient) * (identity + from).inverse();
    advance(fixture, now,
            {split_increment(now.cell, part - identity), steps, step,
             physical ? Loading::physical : Loading::quasi_static});
    report.substeps += steps;
    if (report.substeps > fixture.options.max_substeps)
      throw IncrementFailed("the increment needs more than " + std::to_string(fixture.options.max_substeps) +
                            " sub-steps (solver.max_substeps)");
    if (waiting) waited += steps;
    since_control += double(steps);
    if (since_control >= double(control_stretch)) {
      since_control = 0;
      const Balance balance = checked_balance();
      sums = row_sums(fixture, now);
      if (!physical) {
        if (!waiting) steer_pace(balance, servo.held_stress());
        if (inertia_outgrown(fixture, sums, now)) rescale_inertia(fixture, sums, now);
      }
    }
    // The pace is judged before the wait, whose calm says nothing of it; increments shorter than a stretch have no
    // other moment.
    if (fraction >= 1 && !arrived) {
      arrived = true;
      if (!physical && since_control > 0) steer_pace(checked_balance(), servo.held_stress());
    }
    if (fraction >= 1) {
      report.held_error = servo.held_error(strain, stress());
      if (report.held_error <= target.tolerance) break;
    }
  }
  const Balance balance = checked_balance();
  report.unbalanced_ratio = unbalanced(balance);
  if (!physical && fixture.options.ledger) rescale_inertia(fixture, row_sums(fixture, now), now);
  report.held_error = servo.held_error(strain, stress());
  report.target_held = report.held_error <= target.tolerance;
  return report;
}

}  // namespace rvelab
