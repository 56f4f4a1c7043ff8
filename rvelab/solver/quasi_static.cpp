// Quasi-static loading (dt = 0): an increment becomes as many sub-steps as its tolerance asks for. The strain of a
// sub-step, the pace, follows the unbalanced-force ratio; what ratio an increment may have, and how many sub-steps a
// start or a turn takes, follows from its tolerance (loading/accuracy.hpp). Declared in rve_impl.hpp.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "rvelab/error.hpp"
#include "rvelab/solver/assembly/pressure.hpp"
#include "rvelab/solver/loading/accuracy.hpp"
#include "rvelab/solver/loading/strain_path.hpp"
#include "rvelab/solver/rve_impl.hpp"

namespace rvelab {

namespace {

/// With a given unbalanced ratio: fewest sub-steps of an increment. With fewer the grains cannot leave the affine
/// motion, and the answer is the stiffer affine one (1 % of the stress increment takes 20, measured).
constexpr long fewest_steps = 20;

/// The same where the increment turns back on the last one, whose velocities still go on: 20 left 10 % of an increment
/// of 1e-5 (kappa 1e3, 1e4 increments with signs in turn), 30 4 %, 40 1 %.
constexpr long fewest_steps_back = 40;

/// Strain of a quasi-static sub-step in which no grain touches another.
constexpr double pace_of_gas = 1e-5;
/// Strain of a sub-step that no scene asks for: with less the number of sub-steps would be none.
constexpr double least_pace = 1e-30;

/// Sub-steps before an increment is refused for the number that the present pace would need: where the contacts open,
/// the pace of the dense start says little of what follows (an expansion by a tenth at kn/(p t) = 1e5: 6e7 expected,
/// 18,482 made).
constexpr long settling_steps = 100'000;

/// Sub-steps from which the end of an increment is looked at, whenever the last look was. Shorter ones are judged by
/// what is expected of them, so that a call costs little more than its sub-steps.
constexpr long looked_at_steps = 10;

/// The same for the strain of an increment: contacts and overlaps may be others by then.
constexpr double strain_looked_at = 1e-4;

/// Increments that go on in the direction of the last are judged together, up to this strain: a path cut finely is the
/// same path.
constexpr double longest_leg = 1e-4;

/// Unbalanced ratios that a tolerance may lead to. Under stress control: peak angles of dense discs are 29.0, 29.2 and
/// 29.4 degrees at 1e-2, 1e-3 (the default tolerances) and 1e-4, for 1, 4 and 30 times the time.
constexpr double least_target = 1e-7, largest_target = 2e-3, largest_target_of_held_path = 1e-2;

/// How many sub-steps a start needs so that it leaves no more than `target` of imbalance; `rate` is the strain of the
/// sub-step before it. From `steps` on.
double steps_of_start(const Matrix3& change, double strain, const Matrix3& rate, double strain_of_overlap,
                      double target, double steps) {
  constexpr double most = 1e6;
  // Where the direction goes on, what a change of pace stirs up calms over the increments that follow.
  const double onward = change.cwiseProduct(rate).sum();
  if (onward > 0.9 * change.norm() * rate.norm()) target *= 2;
  const double norm = change.norm();
  if (!(norm > 0)) return steps;
  while (steps < most) {
    const double mismatch = (change - steps * rate).norm() / norm;
    if (unbalance_of_start(mismatch, strain, strain_of_overlap, steps) <= target) break;
    steps = std::ceil(1.1 * steps + 0.5);
  }
  return steps;
}

/// By how much the stress of a copy changes within so many sub-steps at rest, Pa.
double change_at_rest(const Fixture& f, Assembly copy, long steps) {
  const FrameSplit still{Matrix3::Identity(), Matrix3::Identity(), true};
  const auto stress = [&]() -> Matrix3 {
    const Matrix3 in_cell = contact_moment(f, copy) / copy.cell.volume();
    return copy.cell.rotation * in_cell * copy.cell.rotation.transpose();
  };
  const Matrix3 before = stress();
  advance(f, copy, {still, steps, 1, Loading::quasi_static});
  return (stress() - before).norm();
}

}  // namespace

void Rve::Impl::begin_quasi_static() {
  if (!now.state.quasi_static) moved();  // dashpots let go
  begin_loading(fixture, now, Loading::quasi_static);
  unknown_balance = now.state.look_steps < 0;
  if (!unknown_balance) return;
  scale_inertia(fixture, present_sums(), now);
  now.state.softness = 1;
  now.state.lag_factor = now.state.lag_strain = 0;
  now.state.lag_steps = now.state.rest_steps = 0;
  now.state.constraint_ratio = constraint_ratio();
  begin_interval(present_balance());
}

void Rve::Impl::begin_interval(const Balance& balance) {
  SolverState& state = now.state;
  state.look_steps = 0;
  state.interval_strain = 0;
  state.interval_stress = present_stress();
  state.network_stiffness =
      network_stiffness(pressure(), balance.mean_overlap, 2 * fixture.mean_radius, fixture.hardening);
}

void Rve::Impl::renew_interval(const Balance& balance) {
  SolverState& state = now.state;
  rescale_inertia(fixture, present_sums(), now);
  const double network = network_change(state.interval_strain);
  if (network > 0) {
    // Half of the way, as factors go: stress falls by jumps in flow, and one jump is no stiffness.
    const double measured = std::clamp((present_stress() - state.interval_stress).norm() / network, 0.4, 1.0);
    state.softness = std::sqrt(state.softness * measured);
  }
  begin_interval(balance);
}

Balance Rve::Impl::look() {
  const Balance balance = checked_balance();
  unknown_balance = false;
  now.state.unbalanced_ratio = unbalanced(balance);
  ratio_holds = true;
  if (now.state.look_steps >= control_interval) renew_interval(balance);
  return balance;
}

bool Rve::Impl::end_is_looked_at(long substeps, double strain) const {
  return unknown_balance || now.state.look_steps >= control_interval || substeps >= looked_at_steps ||
         strain > strain_looked_at;
}

double Rve::Impl::pressure() { return mean_pressure(present_stress(), fixture.dimension()); }

double Rve::Impl::pressure_scale() {
  // The unbalanced ratio has the same floor. Without it a start in a cell that had come apart, at 1 Pa of 1e5, took a
  // million sub-steps, and 15 such cells of 800 took 98 % of a biaxial test's time.
  return std::max(pressure(), 1e-3 * now.state.reference_pressure);
}

double Rve::Impl::allowed_by_tolerances(double stress_change, double network) {
  const SolverOptions& o = fixture.options;
  return allowed_error(o.relative_tolerance, o.absolute_tolerance, stress_change, network, pressure_scale());
}

double Rve::Impl::network_change(double strain) const { return now.state.network_stiffness * strain; }

double Rve::Impl::initial_pace() {
  // A thousandth of the mean overlap per diameter and step: the strain that changes contact forces by about as much.
  const double overlap = std::max(present_balance().mean_overlap, 0.1 * now.state.reference_overlap);
  return 1e-3 * overlap / (2 * fixture.mean_radius);
}

double Rve::Impl::unbalanced(const Balance& balance) const {
  return rvelab::unbalanced_ratio(balance, now.state.reference_contact_force);
}

double Rve::Impl::target_for(double network) {
  if (fixture.options.target_unbalanced > 0) return fixture.options.target_unbalanced;
  if (!(pressure() > 0)) return largest_target;
  const double allowed = allowed_by_tolerances(now.state.softness * network, network);
  return std::clamp(allowed / (pace_margin * expected_error(1)), least_target, largest_target);
}

double Rve::Impl::tolerance_of_held_path() const {
  return std::max(fixture.options.relative_tolerance, fixture.options.absolute_tolerance);
}

double Rve::Impl::target_of_held_path() const {
  if (fixture.options.target_unbalanced > 0) return fixture.options.target_unbalanced;
  return std::clamp(held_path_ratio(tolerance_of_held_path()), least_target, largest_target_of_held_path);
}

void Rve::Impl::set_pace_target(double target) {
  SolverState& state = now.state;
  if (state.strain_per_step == 0) {
    state.strain_per_step = initial_pace();
    // What that pace leaves of a dense packing: 2e-4 to 4e-4.
    state.pace_target = fixture.options.target_unbalanced > 0 ? target : 3e-4;
  }
  if (state.pace_target > 0 && state.pace_target != target)
    state.strain_per_step = std::clamp(state.strain_per_step * (target / state.pace_target), least_pace, 1.0);
  state.pace_target = target;
}

void Rve::Impl::steer_pace(const Balance& balance, double held_stress) {
  // n <- n (unb/target)^0.75 within 0.5 to 1.4 (power 0.7 was best; three quarters needs square roots only).
  const double x = unbalanced(balance) / now.state.pace_target;
  const double root = std::sqrt(x);
  const double factor = std::clamp(root * std::sqrt(root), 0.5, 1.4);
  // Never so fast that a step changes the overlaps by more than a hundredth, nor, at an unbalanced ratio of 1e-3, a
  // fiftieth of that slow: where grains flow without a network the ratio stays near one at any pace. Stricter
  // ratios may go four times slower; in flow at no pressure no pace would do.
  const double overlap = std::max(balance.mean_overlap, 0.1 * now.state.reference_overlap) / (2 * fixture.mean_radius);
  const double fastest = balance.touching > 0 ? 1e-2 * overlap : pace_of_gas;
  const double slow = 0.02 * fixture.softest_answer * std::clamp(1e3 * now.state.pace_target, 0.25, 1.0);
  // Where a stress is held far below the specimen's own, the reference would let a step be as large as the overlaps.
  // They are judged by the stress that is asked for: in an avalanche they vanish, and a pace that followed them would
  // make one record cost as much as the whole test (730,000 sub-steps).
  double slowest = slow * fastest;
  if (held_stress > 0 && now.state.reference_pressure > 0 && balance.touching > 0) {
    const double share = std::clamp(held_stress / now.state.reference_pressure, 1e-4, 1.0);
    slowest = std::min(slowest, slow * 1e-2 * share * now.state.reference_overlap / (2 * fixture.mean_radius));
  }
  now.state.strain_per_step = std::clamp(now.state.strain_per_step / factor, slowest, fastest);
}

void Rve::Impl::judge(Report& report) {
  // Steered, the ratio stays within 2 times its target for 97 % of the records of a dense biaxial test, peak and flow
  // included; beyond three times the pace was at its floor, or the increment too short for the control to answer.
  constexpr double allowed = 3;
  const double target = now.state.pace_target > 0 ? now.state.pace_target : target_for(0);  // nothing loaded yet
  report.quasi_static = report.unbalanced_ratio <= allowed * target && report.target_held;
}

bool Rve::Impl::was_coarser(double network) { return now.state.pace_target > 2 * target_for(network); }

void Rve::Impl::step_at_rest(long steps) {
  const FrameSplit still{Matrix3::Identity(), Matrix3::Identity(), true};
  advance(fixture, now, {still, steps, 1, Loading::quasi_static});
  moved();
}

Rve::Impl::Rest Rve::Impl::follow_up(double strain, bool turns) {
  const double leg =
      turns ? now.state.leg_strain : std::max(strain, std::min(now.state.leg_strain + strain, longest_leg));
  const double network = network_change(leg);
  Rest rest;
  if (!turns && !was_coarser(network)) return rest;
  const double allowed = allowed_by_tolerances(now.state.softness * network, network);
  // 300 to 1,000 sub-steps take a lag of 1e-2 p to 1e-4 p (drawn increments in flow); what the most leave is estimated.
  constexpr long interval = 25, most = 2000;
  std::vector<Matrix3> stresses;
  while (rest.steps < most &&
         expected_error(now.state.unbalanced_ratio) > (rest.steps > 0 ? 1 / pace_margin : 1) * allowed) {
    stresses.push_back(present_stress());
    step_at_rest(interval);
    look();
    rest.steps += interval;
  }
  if (rest.steps == 0) return rest;
  rest.creep = std::max((present_stress() - stresses[stresses.size() / 2]).norm(),
                        accuracy::slow_share * (present_stress() - stresses[0]).norm());
  if (!fixture.contact.rolling) return rest;
  // Grains that roll past each other creep on at nearly the same rate long after the others are calm.
  const double shown = change_at_rest(fixture, now, accuracy::creep_steps);
  grain_steps_made += std::uint64_t(accuracy::creep_steps) * fixture.size();
  rest.creep = std::max(rest.creep, accuracy::creep_goes_on * shown);
  return rest;
}

void Rve::Impl::turn_back() {
  SolverState& state = now.state;
  // Turned back, the network is elastic again; and velocities that go the other way are worse than none.
  stop_grains(fixture, now);
  state.last_rate.setZero();
  state.softness = 1;
  state.interval_strain = 0;
  state.interval_stress = present_stress();
}

double Rve::Impl::most_substeps(double strain) const {
  const SolverOptions& o = fixture.options;
  const double overlaps = strain * 2 * fixture.mean_radius / now.state.reference_overlap;
  const double strictness = std::max(1.0, std::min(1e-2 / o.relative_tolerance, 1e-4 / o.absolute_tolerance));
  return strictness * (accuracy::most_steps + accuracy::most_steps_of_overlap * overlaps);
}

Rve::Impl::Start Rve::Impl::start_of(const Matrix3& change, double strain, bool turned_back) {
  const SolverState& state = now.state;
  if (!by_tolerance()) return {double(turned_back ? fewest_steps_back : fewest_steps), 0};
  if (!(state.network_stiffness > 0)) return {1, 0};
  const double overlap = overlap_strain();
  const double paced = std::max(1.0, std::ceil(strain / state.strain_per_step));
  const double steps = steps_of_start(change, strain, state.last_rate, overlap, state.pace_target, paced);
  const double mismatch = (change - steps * state.last_rate).norm() / change.norm();
  return {steps, unbalance_of_start(mismatch, strain, overlap, steps)};
}

Rve::Impl::Made Rve::Impl::make_substeps(const StrainPath& path, double strain, double fewest, Report& report) {
  const SolverOptions& o = fixture.options;
  SolverState& state = now.state;
  const Matrix3 start_frame = now.cell.rotation;
  Matrix3 done = Matrix3::Identity();
  const double most = by_tolerance() ? std::max(most_substeps(strain), 1.0) : std::numeric_limits<double>::infinity();
  double fraction = 0;
  Made made;
  double ratios = 0;
  long looks = 0;
  fewest = std::min(fewest, most);
  while (fraction < 1) {
    const double left = 1 - fraction;
    // Where contacts open no pace may calm the grains: the sub-steps have an end, and the estimate says what they
    // leave.
    const double slowest = left * strain / std::max(most - double(report.substeps), double(control_interval));
    state.strain_per_step = std::max(state.strain_per_step, slowest);
    long steps_left = 0;
    bool paced = true;
    if (o.fixed_substeps > 0) {
      steps_left = std::max(1L, std::lround(left * double(o.fixed_substeps)));
      paced = false;
    } else {
      const double count = std::ceil(left * strain / state.strain_per_step), at_least = std::ceil(left * fewest);
      steps_left = long(std::clamp(std::max(count, at_least), 1.0, 1e15));
      paced = count >= at_least;
    }
    const bool hopeless = left * strain / pace_of_gas > double(o.max_substeps);
    const bool settled = !paced || hopeless || report.substeps >= settling_steps;
    expect_substeps(report.substeps, settled ? steps_left : 1);
    const long steps = steps_left <= control_interval + control_interval / 2 ? steps_left : control_interval;
    const double before = fraction;
    fraction = steps == steps_left ? 1.0 : fraction + left * double(steps) / double(steps_left);
    const Matrix3 next = path.at(fraction);
    advance(fixture, now, {next_part(start_frame, now.cell, done, next), steps, 1, Loading::quasi_static});
    moved();
    done = next;
    report.substeps += steps;
    state.interval_strain += (fraction - before) * strain;
    made.looked = fraction == 1 ? end_is_looked_at(report.substeps, strain) : state.look_steps >= control_interval;
    if (!made.looked) continue;
    const Balance balance = look();
    ratios += state.unbalanced_ratio;
    made.mean_ratio = ratios / double(++looks);
    // Where the fewest steps rule, the pace is not that of these steps, but it may still be found too fast.
    const bool too_fast = state.unbalanced_ratio > state.pace_target;
    if (o.fixed_substeps == 0 && (paced || too_fast)) steer_pace(balance);
    // What they were to calm is calm: of a faster path before, which the law of starts takes for as many as 4e5. That
    // holds where contacts stay what they are.
    constexpr double few = 2 * double(control_interval);
    if (strain < overlap_strain() && !too_fast && left * fewest > few) fewest = std::max(0.5 * fewest, few / left);
  }
  return made;
}

Report Rve::Impl::load_quasi_static(FrameSplit whole) {
  Report report;
  SolverState& state = now.state;
  if (has_deferred()) {
    whole.stretch = (whole.stretch * state.deferred_stretch).eval();
    state.deferred_stretch.setIdentity();
  }
  begin_quasi_static();
  const Matrix3 start_frame = now.cell.rotation, change = whole.stretch - Matrix3::Identity();
  const StrainPath path(whole, false);
  const double strain = path.strain(), along = state.last_rate.cwiseProduct(change).sum();
  const bool turns = along < 0.9 * strain * state.last_rate.norm();
  const Rest rest = by_tolerance() ? follow_up(strain, turns) : Rest();
  report.substeps += rest.steps;
  if (turns) state.lag_strain = 1;  // what was measured before is no longer so
  const Matrix3 stress_before = present_stress();
  if (along <= 0) state.leg_strain = 0;
  state.leg_strain = std::min(state.leg_strain + strain, longest_leg);
  if (by_tolerance() && along < 0) turn_back();
  const double judged = network_change(std::max(strain, state.leg_strain));
  set_pace_target(target_for(judged));
  const Start start = start_of(change, strain, along < 0);
  const Made made = make_substeps(path, strain, start.fewest, report);
  if (!present_stress().allFinite())
    throw IncrementFailed("the increment led to values that are not finite; apply it in smaller parts");
  // Between looks a start is believed to leave what starts do.
  if (!made.looked) state.unbalanced_ratio = std::max(start.unbalanced_ratio, state.unbalanced_ratio);
  report.unbalanced_ratio = state.unbalanced_ratio;
  judge(report);
  estimate_error(strain, judged, stress_before, state.unbalanced_ratio, rest.creep, report);
  judge_way(strain, made.mean_ratio, report);
  const bool same_frame = (now.cell.rotation.array() == start_frame.array()).all();
  note_slope(whole.stretch, stress_before, same_frame);
  if (!(whole.rotation.array() == Matrix3::Identity().array()).all()) {
    const Matrix3 turned = turned_since(start_frame, now.cell);
    turn_frame(now.cell, turned.transpose() * whole.rotation * turned);
  }
  return report;
}

}  // namespace rvelab
