#include "rvelab/protocol/run.hpp"

#include <chrono>

#include "rvelab/error.hpp"
#include "rvelab/protocol/drive.hpp"
#include "rvelab/protocol/stage_kind.hpp"

namespace rvelab::protocol {
namespace {

TestRun finish(const Protocol& protocol, RunningTest& test, double wall_before) {
  const auto begin = std::chrono::steady_clock::now();
  TestRun& run = test.run;
  const auto clock = [&] {
    run.progress.wall_seconds =
        wall_before + std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  test.clock = clock;
  try {
    while (run.progress.stage < static_cast<std::int32_t>(protocol.stages.size())) {
      const Stage& stage = protocol.stages[static_cast<std::size_t>(run.progress.stage)];
      test.enter(stage);
      stage.what->drive(test);
      test.leave_stage();
    }
  } catch (const Interrupted&) {
    run.complete = false;
  }
  clock();
  run.result.axis = run.progress.axis;
  run.result.pressure = run.progress.pressure;
  run.result.grain_steps = test.rve.grain_steps() - run.progress.first_grain_steps;
  run.result.wall_seconds = run.progress.wall_seconds;
  run.end_state = test.rve.specimen();
  const StepTimes& times = test.times;
  const double steps = times.grains + times.pairs + times.list;
  run.costs.grains = times.grains;
  run.costs.pairs = times.pairs;
  run.costs.list = times.list;
  run.costs.control = times.calls - steps;
  return std::move(run);
}

}  // namespace

TestRun run_protocol(const Protocol& protocol, const Specimen& specimen, const Watch& watch) {
  const Specimen start = with_overrides(protocol, specimen);
  RunningTest test(protocol, start, watch);
  test.run.progress.stress = test.rve.stress();
  test.run.progress.first_grain_steps = test.rve.grain_steps();
  return finish(protocol, test, 0);
}

TestRun resume_protocol(const Protocol& protocol, const records::Checkpoint& checkpoint, records::TestResult so_far,
                        const Watch& watch) {
  const records::Progress& progress = checkpoint.progress;
  const auto stages = static_cast<std::int32_t>(protocol.stages.size());
  const auto records = static_cast<std::size_t>(progress.records), probes = static_cast<std::size_t>(progress.probes);
  if (progress.stage < 0 || progress.stage > stages || progress.records < 0 || progress.probes < 0 ||
      records > so_far.records.size() || probes > so_far.probes.size()) {
    throw InputError(protocol.path + ": the checkpoint stands in stage " + std::to_string(progress.stage) + " after " +
                     std::to_string(progress.records) + " records and " + std::to_string(progress.probes) +
                     " probes; allowed: at most " + std::to_string(stages) + ", " +
                     std::to_string(so_far.records.size()) + " and " + std::to_string(so_far.probes.size()) +
                     "; give the protocol that it was made with");
  }
  RunningTest test(protocol, checkpoint.specimen, watch);
  test.run.progress = progress;
  so_far.records.resize(records);
  so_far.probes.resize(probes);
  so_far.stages = test.run.result.stages;
  test.run.result = std::move(so_far);
  test.run.result.protocol = protocol.name;
  return finish(protocol, test, progress.wall_seconds);
}

}  // namespace rvelab::protocol
