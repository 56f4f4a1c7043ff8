// apply: an increment becomes sub-steps. Quasi-static loading picks its pace by the unbalanced-force ratio (measured
// best, performance: nearly free and within a few 1e-4 of the stress); physical loading by the critical step.
// Declared in rve_impl.hpp.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "rvelab/error.hpp"
#include "rvelab/solver/loading/collisions.hpp"
#include "rvelab/solver/rve_impl.hpp"

namespace rvelab {

namespace {

constexpr long physical_stretch = 100;  ///< sub-steps between renewals of the critical step

/// Fewest sub-steps of a quasi-static increment: with fewer the grains cannot leave the affine motion, and the answer
/// is the stiffer affine one (1 % of the stress increment takes 20, measured).
constexpr long fewest_steps = 20;

/// The same where the increment turns back on the last one, whose velocities still go on: 20 left 10 % of an increment
/// of 1e-5 (kappa 1e3, 1e4 increments with signs in turn), 30 4 %, 40 1 %.
constexpr long fewest_steps_back = 40;

/// Strain of a quasi-static sub-step in which no grain touches another.
constexpr double pace_of_gas = 1e-5;

/// Sub-steps before an increment is refused for the number that the present pace would need: where the contacts open,
/// the pace of the dense start says little of what follows (an expansion by a tenth at kn/(p t) = 1e5: 6e7 expected,
/// 18,482 made).
constexpr long settling_steps = 100'000;

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

const RowSums& Rve::Impl::present_sums() {
  if (!sums_hold) sums = row_sums(fixture, now);
  sums_hold = true;
  return sums;
}

void Rve::Impl::begin_quasi_static() {
  begin_loading(fixture, now, Loading::quasi_static);
  // Quasi-static loading leaves the masses as its last state asks for (rescale_inertia), so that nothing changes here.
  scale_inertia(fixture, present_sums(), now);
}

Balance Rve::Impl::checked_balance() const {
  check_height(fixture, now.cell);  // the list looks too, but only when it is built anew
  const Balance balance = balance_of(fixture, now);
  check_overlaps(fixture, balance);
  return balance;
}

TimeStep Rve::Impl::time_step(const Matrix3& rate, long stretch, double dt) {
  const double fixed = fixture.options.fixed_time_step;
  if (fixed > 0)
    return {fixed, stretch, collisions_ahead(fixture, now, nullptr, false, {rate, double(stretch) * fixed, dt}).deep};
  present_sums();
  double stable = fixture.options.time_step_factor * critical_step(fixture, with_floor(sums, fixture));
  // Strong local damping takes (1 - alpha) to (1 + alpha) of the force as the motion turns: at 0.99 an eighth of the
  // energy came from nowhere at the critical step. (2 (1 - alpha))^(3/4): with the root the ledger is open by 1.7 %.
  const double freedom = 2 * (1 - fixture.damping.local);
  if (freedom < 1) stable *= std::sqrt(freedom * std::sqrt(freedom));
  const double horizon = std::min(double(stretch) * stable, dt);
  const Collisions ahead = collisions_ahead(fixture, now, &sums, true, {rate, horizon, dt});
  const double longest = std::min(stable, ahead.step);
  const double steps = std::clamp(std::ceil(ahead.look / longest), 10.0, double(stretch));
  return {longest, long(steps), ahead.deep};
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
  const double overlap = std::max(balance.mean_overlap, 0.1 * now.state.reference_overlap) / (2 * fixture.mean_radius);
  const double fastest = balance.touching > 0 ? 1e-2 * overlap : pace_of_gas;
  // Where a stress is held far below the specimen's own, the reference would let a step be as large as the overlaps.
  // They are judged by the stress that is asked for: in an avalanche they vanish, and a pace that followed them would
  // make one record cost as much as the whole test (730,000 sub-steps).
  double slowest = 0.02 * fastest * fixture.softest_answer;
  if (held_stress > 0 && now.state.reference_pressure > 0 && balance.touching > 0) {
    const double share = std::clamp(held_stress / now.state.reference_pressure, 1e-4, 1.0);
    slowest = std::min(slowest, 0.02 * 1e-2 * share * now.state.reference_overlap / (2 * fixture.mean_radius) *
                                    fixture.softest_answer);
  }
  now.state.strain_per_step = std::clamp(now.state.strain_per_step / factor, slowest, fastest);
}

void Rve::Impl::judge(Report& report) const {
  // Steered, the ratio stays within 2 times its target for 97 % of the records of a dense biaxial test, peak and flow
  // included; beyond three times the pace was at its floor, or the increment too short for the control to answer.
  constexpr double allowed = 3;
  report.quasi_static = report.unbalanced_ratio <= allowed * fixture.options.target_unbalanced && report.target_held;
}

Advance loading_of(const Fixture& f, const FrameSplit& increment, long steps, double step, bool physical, bool deep) {
  if (!physical) return {increment, steps, step, Loading::quasi_static};
  return {increment, steps, step, Loading::physical, f.options.fixed_time_step == 0, deep ? deep_look : 0};
}

Report Rve::Impl::load(const Matrix3& dh, double dt) {
  Report report;
  const FrameSplit whole = split_increment(now.cell, dh);
  const bool physical = dt > 0;
  if (!physical && (dh.isZero(0) || whole.rigid)) {
    report.unbalanced_ratio = unbalanced(balance_of(fixture, now));
    judge(report);
  }
  if (!physical && (dh.isZero(0))) return report;
  if (!physical && whole.rigid) {
    const Matrix3 turned = (Matrix3::Identity() + dh) * now.cell.rotation;
    const bool quarter_turn = (dh + Matrix3::Identity()).unaryExpr([](double x) { return x * x * x - x; }).isZero(0);
    turn_frame(now.cell, whole.rotation);
    if (quarter_turn) now.cell.rotation = turned;  // rows change places, no bit of them is lost
    return report;
  }
  if (physical)
    begin_loading(fixture, now, Loading::physical);
  else
    begin_quasi_static();
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

  const bool turns_back = now.state.last_rate.cwiseProduct(whole.stretch - identity).sum() < 0;
  double fraction = 0;
  Matrix3 done = identity;
  while (fraction < 1) {
    const double left = 1 - fraction;
    double step = 1;
    long steps_left, stretch;
    bool paced = true;
    TimeStep time_step;
    if (physical) {
      const Matrix3 rate = report.substeps == 0 ? Matrix3((whole.stretch - identity) / dt) : now.state.last_rate;
      time_step = this->time_step(rate, physical_stretch, dt);
      const double count = std::ceil(left * dt / time_step.longest * (1 - 1e-9));
      steps_left = long(std::clamp(count, 1.0, 1e15));
      step = left * dt / double(steps_left);
      stretch = time_step.stretch;
    } else if (fixture.options.fixed_substeps > 0) {
      steps_left = std::max(1L, std::lround(left * double(fixture.options.fixed_substeps)));
      stretch = control_stretch;
      paced = false;
    } else {
      const double count = std::ceil(left * strain / now.state.strain_per_step);
      const double fewest = std::ceil(left * double(turns_back ? fewest_steps_back : fewest_steps));
      steps_left = long(std::clamp(std::max(count, fewest), 1.0, 1e15));
      paced = count >= fewest;
      stretch = control_stretch;
    }
    const bool hopeless = left * strain / pace_of_gas > double(fixture.options.max_substeps);
    const bool settled = !paced || hopeless || report.substeps >= settling_steps;
    if (report.substeps + (settled ? steps_left : 1) > fixture.options.max_substeps)
      throw IncrementFailed("the increment needs " + std::to_string(report.substeps + steps_left) +
                            " sub-steps; solver.max_substeps allows " + std::to_string(fixture.options.max_substeps));
    const long steps = steps_left <= stretch + stretch / 2 ? steps_left : stretch;
    fraction = steps == steps_left ? 1.0 : fraction + left * double(steps) / double(steps_left);
    const Matrix3 next = done_at(fraction);
    const Matrix3 part = next * done.inverse();
    Cell since_start = now.cell;
    since_start.rotation = turned_since_start();
    const Advanced made = advance(
        fixture, now,
        loading_of(fixture, split_increment(since_start, part - identity), steps, step, physical, time_step.deep));
    moved();
    done = next;
    report.substeps += made.steps;
    const Balance balance = checked_balance();
    report.unbalanced_ratio = unbalanced(balance);
    if (physical) continue;
    // Where the fewest steps rule, the pace is not that of these steps, but it may still be found too fast.
    const bool too_fast = report.unbalanced_ratio > fixture.options.target_unbalanced;
    if (paced || (too_fast && fixture.options.fixed_substeps == 0)) steer_pace(balance);
    if (inertia_outgrown(fixture, present_sums(), now)) rescale_inertia(fixture, present_sums(), now);
  }
  if (!physical && fixture.options.ledger) rescale_inertia(fixture, present_sums(), now);
  if (!physical) judge(report);
  if (!physical && !(whole.rotation.array() == identity.array()).all()) {
    const Matrix3 turned = turned_since_start();
    turn_frame(now.cell, turned.transpose() * whole.rotation * turned);
  }
  return report;
}

}  // namespace rvelab
