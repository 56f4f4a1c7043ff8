// Relax stages: quasi-static steps at fixed cell. Declared in stage_kinds.hpp.
#include <sstream>

#include "rvelab/error.hpp"
#include "rvelab/keys/key_builders.hpp"
#include "rvelab/protocol/drive.hpp"
#include "rvelab/protocol/stage_kinds.hpp"

namespace rvelab::protocol {
namespace {

using namespace keys;

std::vector<TableKey> entries() {
  const char* t = "stage.relax";
  const RelaxStage initial;
  return {
      number(t, "unbalanced", "1", initial.unbalanced, ratio, "unbalanced force ratio below which the stage ends"),
      whole_number(t, "max_steps", initial.max_steps, steps, "sub-steps before it fails"),
      boolean(t, "record", initial.record, "records the state at the end"),
  };
}

RelaxStage read(StageSource& source) {
  TableReader& reader = source.reader;
  RelaxStage stage;
  stage.unbalanced = reader.number("unbalanced");
  stage.max_steps = reader.whole_number("max_steps");
  stage.record = reader.boolean("record");
  return stage;
}

/// Phases of a relax stage.
enum Phase : std::int32_t { begun = 1, relaxing };

void drive(RunningTest& test, const RelaxStage& stage) {
  if (test.run.progress.phase == begun) {
    if (stage.record) test.record_now(0);
    test.run.progress.phase = relaxing;
  }
  const Report report = test.relax(stage.unbalanced, stage.max_steps);
  if (report.unbalanced_ratio > stage.unbalanced) {
    std::ostringstream text;
    text << "the unbalanced ratio is " << report.unbalanced_ratio << " after " << report.substeps
         << " steps; wanted: " << stage.unbalanced << "; raise max_steps or unbalanced";
    throw test.failed(text.str());
  }
  if (stage.record) test.record_now(0);
}

}  // namespace

StageKind relax_kind() {
  return KindOf<RelaxStage>{
      .name = "relax",
      .keys = entries,
      .read = read,
      .drive = drive,
      .planned_records = [](const RelaxStage& stage) -> std::size_t { return stage.record ? 2 : 0; },
      .takes_events = false};
}

}  // namespace rvelab::protocol
