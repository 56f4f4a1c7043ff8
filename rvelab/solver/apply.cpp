// apply: an increment of displacement gradient at dt > 0, in sub-steps of the critical step and of the collisions
// ahead. What is common to it and to quasi-static loading. Declared in rve_impl.hpp.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "rvelab/error.hpp"
#include "rvelab/solver/loading/collisions.hpp"
#include "rvelab/solver/loading/frequency.hpp"
#include "rvelab/solver/loading/strain_path.hpp"
#include "rvelab/solver/rve_impl.hpp"

namespace rvelab {

namespace {

constexpr long physical_interval = 100;  ///< sub-steps between renewals of the critical step

}  // namespace

const RowSums& Rve::Impl::present_sums() {
  if (!sums_hold) sums = row_sums(fixture, now);
  sums_hold = true;
  return sums;
}

const Matrix3& Rve::Impl::present_stress() {
  if (!stress_holds) stress = -contact_moment(fixture, now) / now.cell.volume();
  stress_holds = true;
  return stress;
}

const Balance& Rve::Impl::present_balance() {
  if (!balance_holds) balance = balance_of(fixture, now);
  balance_holds = true;
  return balance;
}

Balance Rve::Impl::checked_balance() const {
  check_height(fixture, now.cell);  // the list looks too, but only when it is built anew
  const Balance balance = balance_of(fixture, now);
  check_overlaps(fixture, balance);
  return balance;
}

TimeStep Rve::Impl::time_step(const Matrix3& rate, long interval, double dt) {
  const double fixed = fixture.options.fixed_time_step;
  if (fixed > 0) {
    expect_stable(std::min(fixed, dt));
    return {fixed, interval, collisions_ahead(fixture, now, nullptr, false, {rate, double(interval) * fixed, dt}).deep};
  }
  present_sums();
  double stable = fixture.options.time_step_factor * critical_step(fixture, with_floor(sums, fixture));
  // Strong local damping takes (1 - alpha) to (1 + alpha) of the force as the motion turns: at 0.99 an eighth of the
  // energy came from nowhere at the critical step. (2 (1 - alpha))^(3/4): with the root the ledger is open by 1.7 %.
  const double freedom = 2 * (1 - fixture.damping.local);
  if (freedom < 1) stable *= std::sqrt(freedom * std::sqrt(freedom));
  const double horizon = std::min(double(interval) * stable, dt);
  const Collisions ahead = collisions_ahead(fixture, now, &sums, true, {rate, horizon, dt});
  const double longest = std::min(stable, ahead.step);
  const double steps = std::clamp(std::ceil(ahead.look / longest), 10.0, double(interval));
  return {longest, long(steps), ahead.deep};
}

void Rve::Impl::expect_stable(double step) {
  // Of the springs: the bound with dashpots is several times below where restitution 0.1 errs. The row sums are a bound
  // from one side: YADE's step of its dense packing is 1.26 times theirs and stable.
  RowSums springs = present_sums();
  springs.dashpot.clear();
  if (step <= critical_step(fixture, springs)) return;
  const double limit = 2 / frequency_reached(fixture, now);
  if (step <= limit) return;
  throw IncrementFailed("solver.fixed_time_step_s = " + in_words(fixture.options.fixed_time_step) +
                        " s is above the critical step, " + in_words(limit) +
                        " s, of the contacts as they are: energy would come from nowhere; give at most 0.7 of it, or "
                        "0 for steps that follow the contacts");
}

Advance loading_of(const Fixture& f, const FrameSplit& increment, long steps, double step, bool physical, bool deep) {
  if (!physical) return {increment, steps, step, Loading::quasi_static};
  return {increment, steps, step, Loading::physical, f.options.fixed_time_step == 0, deep ? deep_look : 0};
}

void Rve::Impl::expect_substeps(long made, long needed) const {
  if (made + needed <= fixture.options.max_substeps) return;
  throw IncrementFailed("the increment needs " + std::to_string(made + needed) +
                        " sub-steps; solver.max_substeps allows " + std::to_string(fixture.options.max_substeps));
}

Report Rve::Impl::load(const FrameSplit& increment, const Matrix3& dh, double dt) {
  Report report;
  if (dt == 0 && increment.rigid) {
    // The path that led here is what is judged, as it was at its end; a rotation adds nothing.
    const bool known = now.state.quasi_static && now.state.look_steps >= 0;
    report.unbalanced_ratio = known ? now.state.unbalanced_ratio : unbalanced(balance_of(fixture, now));
    judge(report);
    estimate_error(0, network_change(now.state.leg_strain), present_stress(), report.unbalanced_ratio,
                   has_deferred() ? extrapolated(now.state.deferred_stretch).error : 0.0, report);
    if (dh.isZero(0)) return report;
    const Matrix3 turned = (Matrix3::Identity() + dh) * now.cell.rotation;
    const bool quarter_turn = (dh + Matrix3::Identity()).unaryExpr([](double x) { return x * x * x - x; }).isZero(0);
    turn_frame(now.cell, increment.rotation);
    if (quarter_turn) now.cell.rotation = turned;  // rows change places, no bit of them is lost
    set_strained_cell();
    return report;
  }
  long deferred = 0;
  FrameSplit whole = increment;
  if (has_deferred() && !(dt == 0 && joins_deferred(increment))) {
    deferred = make_deferred();
    whole = split_increment(now.cell, dh);  // the lattice may have been reduced, which turns the frame
  }
  report = dt > 0 ? load_physical(whole, dt) : load_quasi_static(whole);
  report.substeps += deferred;
  return report;
}

Report Rve::Impl::load_physical(const FrameSplit& whole, double dt) {
  Report report;
  begin_loading(fixture, now, Loading::physical);
  now.state.stress_slope.setZero();
  const Matrix3 start_frame = now.cell.rotation;
  const StrainPath path(whole, true);
  double fraction = 0;
  Matrix3 done = Matrix3::Identity();
  while (fraction < 1) {
    const double left = 1 - fraction;
    const Matrix3 rate =
        report.substeps == 0 ? Matrix3((whole.stretch - Matrix3::Identity()) / dt) : now.state.last_rate;
    const TimeStep time_step = this->time_step(rate, physical_interval, dt);
    const double count = std::ceil(left * dt / time_step.longest * (1 - 1e-9));
    const long steps_left = long(std::clamp(count, 1.0, 1e15));
    expect_substeps(report.substeps, steps_left);
    const double step = left * dt / double(steps_left);
    const long steps = steps_left <= time_step.interval + time_step.interval / 2 ? steps_left : time_step.interval;
    fraction = steps == steps_left ? 1.0 : fraction + left * double(steps) / double(steps_left);
    const Matrix3 next = path.at(fraction);
    const Advanced made =
        advance(fixture, now,
                loading_of(fixture, next_part(start_frame, now.cell, done, next), steps, step, true, time_step.deep));
    moved();
    done = next;
    report.substeps += made.steps;
    report.unbalanced_ratio = unbalanced(checked_balance());
  }
  return report;
}

}  // namespace rvelab
