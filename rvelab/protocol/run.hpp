// A protocol run on a specimen: every stage through Rve::apply, every record at its strain.
//
// Stress control and error control are inside Rve::apply. The module writes no file: a Watch may keep records and
// checkpoints, show progress, and stop the run.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "rvelab/protocol/protocol.hpp"
#include "rvelab/records/progress.hpp"
#include "rvelab/records/record.hpp"
#include "rvelab/solver/rve.hpp"

namespace rvelab::protocol {

/// Times of a run since it was begun or resumed, s, and the errors of its stresses.
struct Costs {
  double grains = 0, pairs = 0, list = 0, control = 0;  ///< StepTimes; control: what calls took beyond the first three
  double files = 0;                                     ///< filled in by who keeps the records
  long judged = 0;                           ///< records in quasi-static loading that an increment led to, at p > 0
  double mean_error = 0, largest_error = 0;  ///< of those, Report::error_estimate over p
  double largest_error_strain = 0;           ///< of the record of the largest
  long substeps = 0, waited = 0;             ///< Report::substeps and Report::waited of all increments
};

/// A test that was run, or stopped.
struct TestRun {
  records::TestResult result;
  Specimen end_state;
  records::Progress progress;  ///< with end_state the checkpoint from which a stopped test goes on
  bool complete = true;
  std::vector<std::string> events;  ///< that ended stages since the run was begun or resumed, with the stages
  Costs costs;
};

/// A running test between two increments, as its watcher sees it. Valid during the call only.
struct PathPoint {
  const records::Progress& progress;
  const records::TestResult& result;  ///< so far
  const Rve& rve;
  std::size_t records_planned;  ///< of all stages together
  double time = 0;              ///< s, of the increments since the run was begun or resumed; 0: quasi-static
  records::Checkpoint checkpoint() const { return {progress, rve.specimen()}; }
};

/// Functions that a run calls. Each may be empty, is called on the thread of the test and does not change its results.
/// An exception ends the run.
struct Watch {
  std::function<void(const records::Record&)> on_record;
  std::function<void(const records::ProbeResult&)> on_probe;
  /// The state of a record, by its number from 0, where [output] snapshots_every asks for it.
  std::function<void(std::size_t record, const Specimen& state)> on_snapshot;
  /// After each increment, each stage, and about each second of a relaxation: here a checkpoint can be taken.
  std::function<void(const PathPoint&)> on_path_point;
  /// Once true, the run ends within a sub-step at the last point passed (a probe by the linear method ends first).
  const std::atomic<bool>* stop = nullptr;
  bool measure_time = false;  ///< fills in the times of TestRun::costs
  /// Shares the steps of a large specimen (Rve::share).
  Workers* team = nullptr;
};

/// Records that all stages of a protocol make together, where no event ends one before its end.
std::size_t planned_records(const Protocol& protocol);

/// Runs all stages in order. Records lie at the fixed strains of their stage, none skipped or delayed. In quasi-static
/// loading each is of a state whose held stress is there; at a rate one whose held stress was not there on average is
/// kept and flagged (target_held = false). Throws InputError if specimen and protocol do not go together, or if a stage
/// starts far from the stress that it holds; Error (IncrementFailed among them) if a stage cannot be carried out, a
/// held stress that the grains cannot carry among the reasons, naming the stage and what was reached.
TestRun run_protocol(const Protocol& protocol, const Specimen& specimen, const Watch& watch = {});

/// Goes on from a checkpoint of the same protocol: what follows is bitwise what the undisturbed run would have made.
/// `so_far` holds at least the records and probes that the checkpoint counts; those beyond are made again. InputError
/// if the checkpoint does not fit the protocol.
TestRun resume_protocol(const Protocol& protocol, const records::Checkpoint& checkpoint, records::TestResult so_far,
                        const Watch& watch = {});

}  // namespace rvelab::protocol
