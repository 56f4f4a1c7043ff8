// What an Rve holds. Shared by the files that implement it and by nothing else.
#pragma once

#include <utility>

#include "rvelab/error.hpp"
#include "rvelab/solver/assembly/assembly.hpp"
#include "rvelab/solver/loading/inertia.hpp"
#include "rvelab/solver/loading/stepping.hpp"
#include "rvelab/solver/loading/strain_path.hpp"
#include "rvelab/solver/loading/trial.hpp"
#include "rvelab/solver/rve.hpp"

namespace rvelab {

/// Grains up to which an RVE at work keeps the buffers of a trial for the next one (some 10 MB).
constexpr std::size_t largest_kept_scratch = 20'000;

constexpr long control_interval = 50;  ///< sub-steps between looks at the unbalanced ratio

/// The sub-step at dt > 0.
struct TimeStep {
  double longest = 0;  ///< s
  long interval = 0;   ///< sub-steps until the next look
  bool deep = false;   ///< see Collisions
};

class Servo;

struct Rve::Impl {
  Fixture fixture;
  Assembly now;
  std::uint64_t grain_steps_made = 0;  ///< by all trials, whatever became of them
  bool resting = false;                ///< only what rest() keeps is there
  Trial trial;
  RowSums sums;  ///< of stiffness; those of `now` while sums_hold
  bool sums_hold = false;
  Matrix3 stress = Matrix3::Zero();  ///< contact stress, cell frame, Pa; that of `now` while stress_holds
  bool stress_holds = false;
  Balance balance;  ///< of the grains; that of `now` while balance_holds
  bool balance_holds = false;
  bool ratio_holds = false;                ///< state.unbalanced_ratio was measured on `now` as it is, within this call
  Matrix3 other_stress = Matrix3::Zero();  ///< while a trial is pending: the same of the state that is not in `now`
  bool other_stress_holds = false;
  /// Within a call at dt = 0: masses were scaled for grains, contacts or parameters that are others now, and the state
  /// may be no equilibrium any more (friction lowered: the forces show it after a sub-step only).
  bool unknown_balance = false;
  Cell strained_cell;  ///< the cell with the deferred stretch, while there is one

  /// Every public call that changes an Rve comes through here: working arrays are rebuilt, where rest() let go of them,
  /// and a pending trial is reverted.
  Impl& at_work();
  /// The same, with the deferred stretch made: every public call that changes more than the strain. Throws
  /// IncrementFailed; the RVE is then exactly as it was.
  Impl& up_to_date();

  /// The sums of the state as it is, made anew where grains, contacts or parameters changed (moved()). They take as
  /// long as five sub-steps, and the last of one call are the first of the next.
  const RowSums& present_sums();
  /// Contact stress of the state as it is, cell frame, Pa; kept likewise.
  const Matrix3& present_stress();
  /// Balance of the state as it is; kept likewise. The first call after an opening needs what that looked at.
  const Balance& present_balance();
  void moved() { sums_hold = stress_holds = balance_holds = ratio_holds = false; }
  /// begin_loading, and masses if none are scaled yet. They hold for control_interval sub-steps, over as many calls as
  /// that takes, and belong to the state.
  void begin_quasi_static();
  /// dt = 0: masses, and the softness of the interval that ends; the next one begins.
  void renew_interval(const Balance& balance);
  void begin_interval(const Balance& balance);
  /// dt = 0: balance and overlaps; every control_interval sub-steps renew_interval.
  Balance look();
  /// dt = 0: whether the end of an increment of so many sub-steps and this strain is looked at. If not, it is judged by
  /// what is known already, so that a call costs little more than its sub-steps.
  bool end_is_looked_at(long substeps, double strain) const;

  Matrix3 to_lab(const Matrix3& cell_frame) const {
    return now.cell.rotation * cell_frame * now.cell.rotation.transpose();
  }
  Matrix3 contact_stress() const;   ///< of `now`, laboratory frame, Pa
  Matrix3 strained_stress() const;  ///< the same with that of the deferred stretch
  Matrix3 reynolds_stress() const;
  /// Friction lowered since the state was kept: some contact gives way at the next sub-step, whatever that is.
  bool holds_more_than_friction() const;
  // Deferred strain (dt = 0, deferred.cpp): increments that are a small part of a sub-step share one.
  bool has_deferred() const { return !(now.state.deferred_stretch.array() == Matrix3::Identity().array()).all(); }
  bool may_defer(const FrameSplit& increment);
  Report defer(const FrameSplit& increment);
  /// Whether an increment can be made in one with what is deferred.
  bool joins_deferred(const FrameSplit& increment) const;
  /// Makes what is deferred; the number of sub-steps.
  long make_deferred();
  /// Change of the contact stress by a stretch beyond `now`, cell frame, Pa, and what it may err by.
  struct Extrapolated {
    Matrix3 stress = Matrix3::Zero();
    double error = 0;
  };
  Extrapolated extrapolated(const Matrix3& stretch) const;
  /// The slope of an increment that is made, from the stress before it; none where the cell frame turned meanwhile.
  void note_slope(const Matrix3& stretch, const Matrix3& stress_before, bool same_frame);
  void set_strained_cell();

  Response respond(const Report& report, const Matrix3& gradient, double dt, const Want& want);

  void begin_trial(Trial::Changes changes);
  void exchange() noexcept;
  void revert() noexcept;
  void give_up(std::uint64_t grain_steps_before) noexcept;  ///< a trial that failed is reverted; what it made counts
  void settle() noexcept;                                   ///< what is in `now` is the state, and no trial is pending

  /// Runs `work` as a trial, which is then pending; if it throws, the trial is reverted and the exception goes on, a
  /// CellError as IncrementFailed.
  template <class Work>
  auto tried(Trial::Changes changes, Work work) {
    begin_trial(changes);
    const std::uint64_t before = now.state.grain_steps;
    try {
      auto result = work();
      grain_steps_made += now.state.grain_steps - before;
      return result;
    } catch (const CellError& error) {
      give_up(before);
      throw IncrementFailed(error.what());
    } catch (...) {
      give_up(before);
      throw;
    }
  }
  /// The same, committed.
  template <class Work>
  auto guarded(Work work) {
    auto result = tried(Trial::Changes::grains, std::move(work));
    settle();
    return result;
  }

  /// Balance after an interval; throws IncrementFailed on overlap beyond the limit or values not finite.
  Balance checked_balance() const;
  double unbalanced(const Balance& balance) const;  ///< ratio with this specimen's reference force
  /// `held_stress`: what a mixed target holds (Servo::held_stress), Pa; the pace may follow it below the reference.
  void steer_pace(const Balance& balance, double held_stress = 0);
  /// Makes the pace one for the unbalanced ratio `target`; the ratio goes with the pace.
  void set_pace_target(double target);
  /// The ratio that an increment may have whose network change is |C : d eps| (Pa), by tolerance or as given.
  double target_for(double network_change);
  /// The ratio that a path under stress control may have, by tolerance or as given; what its stress may err by, over p.
  double target_of_held_path() const;
  double tolerance_of_held_path() const;
  /// |C : d eps| of a strain, Pa.
  double network_change(double strain) const;
  double pressure();  ///< mean, of present_stress, Pa
  /// What errors of the stress are measured by, Pa: the pressure, or a thousandth of the reference where it is less.
  double pressure_scale();
  /// allowed_error by the tolerances of the specimen, Pa; of a change of stress and |C : d eps|, Pa.
  double allowed_by_tolerances(double stress_change, double network_change);
  /// Constraints of the contacts over the motions of the grains that they hold (loading/accuracy.hpp).
  double constraint_ratio() const;
  /// Strain that changes the contact forces by about as much as they are; infinite without a network.
  double overlap_strain();
  /// Error over p and the unbalanced ratio, of the state as it is, as fitted (loading/accuracy.hpp).
  double error_factor() const;
  /// K p u for an unbalanced ratio u, Pa, as it steers the sub-steps.
  double expected_error(double ratio);
  /// dt = 0, to a tolerance: whether there is a lag to measure; and whether an increment of so many sub-steps is to do
  /// so.
  bool can_measure_lag();
  bool lag_is_due(long substeps);
  /// Lets a copy rest, and notes in the state by what its stress was behind.
  void measure_lag();
  /// Sets report.error_estimate, allowed_error and tolerance_met: `allowed` (Pa), `strain` of the increment, `ratio`
  /// the unbalanced ratio at its end, `more` (Pa) what else the stress may err by.
  void judge_error(double allowed, double strain, double ratio, double more, Report& report);
  /// The same of an increment of this strain; `network_change` (Pa) is that of the path which it is a piece of.
  void estimate_error(double strain, double network_change, const Matrix3& stress_before, double ratio, double more,
                      Report& report);
  /// An increment beyond the strain of the overlaps, of this mean unbalanced ratio: what it lagged by on its way has
  /// slid contacts, of which its end knows nothing. The estimate is at least that.
  void judge_way(double strain, double mean_ratio, Report& report);
  /// dt = 0: sets report.quasi_static from what it says of balance and target.
  void judge(Report& report);
  /// dt > 0: in an increment of the time dt (s), at the velocity gradient `rate` of the cell (1/s, cell frame); the
  /// next look is after `interval` sub-steps at the latest.
  TimeStep time_step(const Matrix3& rate, long interval, double dt);
  /// Throws IncrementFailed if a time step (s) is above the critical one of the state as it is.
  void expect_stable(double step);
  /// A cell height is below four mean diameters.
  bool cell_thin(const Cell& cell) const { return heights(cell).minCoeff() < 8 * fixture.mean_radius; }
  double initial_pace();
  /// Throws IncrementFailed if `needed` sub-steps after `made` are more than solver.max_substeps.
  void expect_substeps(long made, long needed) const;
  /// Scales of the specimen's own state that it does not bring.
  void set_missing_references(const Balance& balance);

  Report load(const FrameSplit& whole, const Matrix3& displacement_gradient, double dt);
  Report load_physical(const FrameSplit& whole, double dt);
  Report load_quasi_static(FrameSplit whole);
  /// Whether the pace was one for more than twice the ratio that a path of this network change (Pa) may have.
  bool was_coarser(double network_change);
  /// Quasi-static sub-steps of a cell that keeps its shape.
  void step_at_rest(long steps);
  struct Rest {
    long steps = 0;
    double creep = 0;  ///< Pa, what a longer one would still bring, about
  };
  /// Before an increment of this strain that turns, or goes on where the pace was one for another target: a state that
  /// lags by more than its tolerance comes to rest. What it lags by would stay: unloading locks the contacts that would
  /// have crept. A path to a tolerance lags by no more than that; one under stress control, or to a given ratio, may by
  /// a hundred times as much.
  Rest follow_up(double strain, bool turns);
  /// Turned back: velocities and softness begin anew.
  void turn_back();
  /// Sub-steps that an increment of this strain makes at most to its tolerance.
  double most_substeps(double strain) const;
  struct Start {
    double fewest;            ///< sub-steps
    double unbalanced_ratio;  ///< expected of that many
  };
  Start start_of(const Matrix3& change, double strain, bool turned_back);
  struct Made {
    bool looked = false;    ///< the balance, after the last sub-step
    double mean_ratio = 0;  ///< unbalanced, of all looks
  };
  /// The sub-steps of a quasi-static increment.
  Made make_substeps(const StrainPath& path, double strain, double fewest, Report& report);
  bool by_tolerance() const { return fixture.options.fixed_substeps == 0 && fixture.options.target_unbalanced == 0; }
  Report load(const MixedTarget& target, double dt, Matrix3& gradient);
  Report load_at_rate(const MixedTarget& target, double dt, Matrix3& gradient);
  Report load_quasi_static(const MixedTarget& target, Matrix3& gradient);
  /// Strain that the overlaps of grains which carry the held stress are worth.
  double strain_of_held(const Servo& servo) const;
};

/// What advance is to do for an increment in the cell frame.
Advance loading_of(const Fixture& fixture, const FrameSplit& increment, long steps, double step, bool physical,
                   bool deep);

}  // namespace rvelab
