// Driving an Rve through one stage: targets of each increment, and the state of a running test. Internal to the module.
//
// A drive keeps its place in RunningTest::run.progress (phase, step) alone, and changes it only together with the state
// that it describes, so that it can resume from any pause.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "rvelab/error.hpp"
#include "rvelab/keys/table_reader.hpp"
#include "rvelab/protocol/run.hpp"
#include "rvelab/solver/loading/step_times.hpp"
#include "rvelab/solver/rve.hpp"

namespace rvelab::protocol {

/// A stress component that an increment brings to a target. Laboratory frame, Pa, tension positive.
struct HeldStress {
  int i, j;
  double target;
  double scale;  ///< Pa, > 0: what the tolerance is relative to
};

/// The mixed target that brings the held components from `stress` to their targets and gives all others the strain of
/// the displacement gradient dH (dimensionless, relative to the start of the increment). The whole skew part is dH's.
/// `held_before`: the increment before had the same targets, so that what is lacking was missed by it.
MixedTarget mixed_target(const Matrix3& displacement_gradient, const std::vector<HeldStress>& held,
                         const Matrix3& stress, int dimension, bool held_before);

/// Strains of the records of a strain-driven stage that goes straight: 0, multiples of the spacing, then the end.
std::vector<double> record_strains(double to_strain, double spacing);

/// A test under way.
class RunningTest {
 public:
  RunningTest(const Protocol& protocol, const Specimen& specimen, const Watch& watch);

  /// Begins a stage (phase 1), unless it is under way: strains and the stage's first p count from here.
  void enter(const Stage& stage);
  /// On to the next stage (phase 0): the one after it, or the one that it, or the event that ended it, names.
  void leave_stage();

  /// One increment of a mixed target that is complete but for its tolerance.
  Report apply(MixedTarget target, double dt, double tolerance);
  /// One increment: held components to their targets, the rest as dH says. Relative tolerance of the held stresses;
  /// dt in s, 0 for quasi-static; `wait` as MixedTarget has it.
  Report apply(const Matrix3& displacement_gradient, const std::vector<HeldStress>& held, double dt, double tolerance,
               long wait = -1);
  /// A relaxation, in slices whose length depends on the number of grains alone; goes on with the one under way.
  Report relax(double unbalanced, long max_steps);
  /// Records at the given strains, the first of them the state as it is, each next one after the increment that
  /// `increment_to(strain)` applies; until the strains or an event end it. progress.step counts the strains done.
  template <class Increment>
  void go_through(const std::vector<double>& strains, Increment increment_to) {
    std::int64_t& done = run.progress.step;
    while (!ended() && done < std::int64_t(strains.size())) {
      const double strain = strains[std::size_t(done)];
      if (done == 0) record_now(strain);
      if (done > 0) record(strain, increment_to(strain));
      step_done();
    }
  }
  /// Cycles between the strains +-`to_strain`, in `steps` equal parts of each amplitude.
  /// `driving_stress(stress)` grows with the driving strain. A turn by stress lies between two of these strains, where
  /// the stress is reached.
  template <class Increment, class DrivingStress>
  void go_to_and_fro(double to_strain, long steps, const Cycles& cycles, Increment increment_to,
                     DrivingStress driving_stress) {
    records::Progress& at = run.progress;
    const double sign = to_strain < 0 ? -1 : 1;
    while (!ended()) {
      const bool forth = at.turns % 2 == 0;
      if (at.step == 0) {
        record_now(0);
      } else {
        const double before = run.result.records.back().strain;
        const double direction = forth ? sign : -sign, spacing = std::abs(to_strain) / double(steps);
        // After a turn by stress the next strain of the grid is the first that is clearly ahead.
        do {
          at.place += forth ? 1 : -1;
        } while (direction * (grid_strain(to_strain, at.place, steps) - before) < 1e-9 * spacing);
        const double strain = grid_strain(to_strain, at.place, steps);
        const bool last = at.turns == 2 * cycles.count;
        if (cycles.reverse_at > 0 && !last) {
          const auto [reached, report] = approach(before, strain, cycles.reverse_at, increment_to,
                                                  [&](const Matrix3& s) { return direction * driving_stress(s); });
          record(reached, report);
        } else {
          record(strain, increment_to(strain));
        }
        const double along = direction * driving_stress(at.stress);
        const bool by_stress = cycles.reverse_at > 0 && along >= cycles.reverse_at;
        if (last && (cycles.reverse_at > 0 ? along >= 0 || at.place == steps : at.place == 0)) at.phase = done_phase;
        if (!last && (by_stress || at.place == (forth ? steps : -steps))) ++at.turns;
      }
      step_done();
    }
  }
  static double grid_strain(double to_strain, std::int64_t place, long steps) {
    return to_strain * double(place) / double(steps);
  }
  /// From the strain of the last record towards another in as many increments as it takes to pass a stress by less than
  /// 1 %. Each goes nine tenths of what is lacking at the slope of the one before it, and from 5 % on to 0.4 % beyond;
  /// the first after a turn, where the slope is not known, goes an eighth of the way. Ends at the strain, or where the
  /// stress is reached; returns the strain and the report of the last increment.
  template <class Increment, class Stress>
  std::pair<double, Report> approach(double from, double to, double reverse_at, Increment increment_to,
                                     Stress stress_along) {
    const double way = to - from;
    const auto part_for = [&](double stress, double slope, double most) {
      constexpr double shortest = 1.0 / 1024;  // of the way
      const double lacking = reverse_at - stress;
      const double wanted = lacking > 0.05 * reverse_at ? 0.9 * lacking : lacking + 0.004 * reverse_at;
      return slope > 0 ? std::clamp(wanted / slope, shortest, most) : most;
    };
    double strain = from, stress = stress_along(run.progress.stress);
    double part = 0.125;
    const auto& records = run.result.records;
    const std::size_t count = records.size();
    if (run.progress.step > 1 && (from - records[count - 2].strain) * way > 0) {
      const double slope =
          (stress - stress_along(records[count - 2].stress)) / (from - records[count - 2].strain) * way;
      part = part_for(stress, slope, 1);
    }
    Report report;
    do {
      const double next = part > 0.999 * (to - strain) / way ? to : strain + part * way;
      report = increment_to(next);
      const double after = stress_along(run.progress.stress);
      part = part_for(after, (after - stress) / (next - strain) * way, 2 * part);
      strain = next;
      stress = after;
    } while (strain != to && stress < reverse_at);
    return {strain, report};
  }
  /// Counts a record of a stage, checks its events, and pauses.
  void step_done();
  bool ended() const { return run.progress.phase >= done_phase; }
  void record(double strain, const Report& report);
  void record_now(double strain);  ///< a state that no increment led to
  void probed(const Eigen::MatrixXd& stiffness);

  /// A point at which the test can be left: calls the watcher; throws Interrupted on request.
  void pause();

  /// At the start of a stage that holds a stress: InputError unless the stress `name` (Pa, compression positive) is
  /// within ten times its tolerance of the held value. A drained test starts from the consolidated state; a jump within
  /// the first record would be a load path that nobody prescribed.
  void expect_consolidated(const std::string& name, double found, double held) const;

  /// Scale of a held stress: with_bonds(max(|target|, 1 % of the stage's first p)). Error if it is 0.
  double held_scale(double target) const;
  /// That scale, Pa; of a specimen with bonds, which can hold a stress of 0, a thousandth of its reference pressure
  /// (times `factor`) at least.
  double with_bonds(double scale, double factor = 1) const;
  /// Time (s) for an increment of the driving strain (dimensionless); 0 when quasi-static.
  double time_for(double strain_increment) const;

  int dimension() const { return rve.cell().dimension; }
  Error failed(const std::string& text) const;  ///< names the stage

  /// Phases of a stage that was ended: by itself, or by its event number phase - done_phase - 1.
  static constexpr std::int32_t done_phase = 1000;

  Rve rve;
  const LoadingSettings& loading;
  TestRun run;
  std::function<void()> clock;  ///< brings progress.wall_seconds up to date
  StepTimes times;              ///< of all increments, where the watcher asks for them

 private:
  template <class Apply>
  Report applied(Apply apply, double dt);
  void note_error(const Report& report, records::Record& record);
  int stage_number(const std::string& name) const;

  const Watch& watch_;
  const Stage* stage_ = nullptr;  ///< under way
  long snapshots_every_;
  std::uint64_t quantities_;
  std::size_t records_planned_;
  double time_ = 0;  ///< s, see PathPoint::time
};

/// InputError if a stage does not go with specimens of this dimension, or names what this one has not.
void expect_fits(const Protocol& protocol, const Specimen& specimen);

/// A quantity that an event may check.
struct EventQuantity {
  const char* name;
  double (*value)(const RunningTest&);
};

/// Those of a running test, and every number of the table of measured quantities (rvelab/records/quantities.hpp).
const std::vector<EventQuantity>& event_quantities();

/// The events of a stage; the stages that they name are looked up once all are read.
std::vector<Event> read_events(keys::TableReader& reader);

/// The first event of the stage that its last record meets, from 0; -1: none. Renews progress.largest.
int met_event(RunningTest& test, const Stage& stage);

}  // namespace rvelab::protocol
