// Driving an Rve through one stage: targets of each increment, and the state of a running test. Internal to the room.
//
// A drive keeps its place in RunningTest::run.progress (phase, step) alone, and changes it only together with the state
// that it describes, so that it can resume from any pause.
#pragma once

#include <functional>
#include <string>
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
  /// `driving_stress()` grows with the driving strain.
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
        at.place += forth ? 1 : -1;
        const double strain = to_strain * double(at.place) / double(steps);
        record(strain, increment_to(strain));
        const double along = (forth ? sign : -sign) * driving_stress();
        const bool by_stress = cycles.reverse_at > 0 && along >= cycles.reverse_at;
        const bool last = at.turns == 2 * cycles.count;
        if (last && (cycles.reverse_at > 0 ? along >= 0 || at.place == steps : at.place == 0)) at.phase = done_phase;
        if (!last && (by_stress || at.place == (forth ? steps : -steps))) ++at.turns;
      }
      step_done();
    }
  }
  /// Counts a record of a stage, checks its events, and pauses.
  void step_done();
  bool ended() const { return run.progress.phase >= done_phase; }
  void record(double strain, const Report& report);
  void record_now(double strain);  ///< a state that no increment led to
  void probed(const Eigen::MatrixXd& stiffness);

  /// A moment at which the test can be left: calls the watcher; throws Interrupted on request.
  void pause();

  /// At the start of a stage that holds a stress: InputError unless the stress `name` (Pa, compression positive) is
  /// within ten times its tolerance of the held value. A drained test starts from the consolidated state; a jump within
  /// the first record would be a load path that nobody prescribed.
  void expect_consolidated(const std::string& name, double found, double held) const;

  /// Scale of a held stress: max(|target|, 1 % of the stage's first p). Error if both vanish.
  double held_scale(double target) const;
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
  void note_error(const Report& report);
  int stage_number(const std::string& name) const;

  const Watch& watch_;
  const Stage* stage_ = nullptr;  ///< under way
  long snapshots_every_;
  std::uint64_t quantities_;
  std::size_t records_planned_;
  double time_ = 0;  ///< s, see Moment::time
};

/// InputError if a stage does not go with specimens of this dimension.
void expect_fits(const Protocol& protocol, int dimension);

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
