#include "rvelab/protocol/run.hpp"

#include <chrono>
#include <stdexcept>

#include "rvelab/error.hpp"
#include "rvelab/protocol/drive.hpp"
#include "rvelab/protocol/stage_kinds.hpp"

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
    while (run.progress.stage < std::int32_t(protocol.stages.size())) {
      const Stage& stage = protocol.stages[std::size_t(run.progress.stage)];
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

std::unique_ptr<StageKind> stage_of_kind(const std::string& name) {
  for (MakeStage* const make : stage_kinds) {
    if (auto stage = make(); stage->name() == name) return stage;
  }
  throw std::logic_error("no kind of stage is called \"" + name + "\" in stage_kinds.hpp");
}

std::string kinds_with_events(bool taking) {
  std::string names;
  for (MakeStage* const make : stage_kinds) {
    const auto kind = make();
    if (kind->takes_events() == taking) names += (names.empty() ? "" : ", ") + std::string(kind->name());
  }
  return names;
}

void expect_fits(const Protocol& protocol, const Specimen& specimen) {
  for (const Stage& stage : protocol.stages) {
    std::string mistake = stage.what->misfit(specimen.cell.dimension);
    if (mistake.empty()) mistake = stage.what->lacking_in(specimen);
    if (!mistake.empty()) throw InputError(protocol.path + ": stage \"" + stage.name + "\": " + mistake);
  }
}

std::size_t planned_records(const Protocol& protocol) {
  std::size_t count = 0;
  for (const Stage& stage : protocol.stages) count += stage.what->planned_records();
  return count;
}

StageRole role_of(const Stage& stage) { return stage.what->role(); }

std::string strength_stages() {
  std::string text;
  for (MakeStage* const make : stage_kinds) {
    const auto kind = make();
    const std::string when = kind->strength_when();
    if (when.empty()) continue;
    text += (text.empty() ? "" : "; or ") + ("kind = \"" + std::string(kind->name()) + "\" with " + when);
  }
  return text;
}

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
  const auto stages = std::int32_t(protocol.stages.size());
  const auto records = std::size_t(progress.records), probes = std::size_t(progress.probes);
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
