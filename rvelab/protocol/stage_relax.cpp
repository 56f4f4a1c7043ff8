// Relax stages: quasi-static steps at fixed cell. Declared in stage_kinds.hpp.

#include "rvelab/error.hpp"
#include "rvelab/keys/table_reader.hpp"
#include "rvelab/protocol/drive.hpp"
#include "rvelab/protocol/stage_kinds.hpp"

namespace rvelab::protocol {
namespace {

using namespace keys;

/// Phases of a relax stage.
enum class RelaxPhase : std::int32_t { begun = 1, relaxing };

struct Relax : KindOf<RelaxStage> {
  const char* name() const override { return "relax"; }
  bool takes_events() const override { return false; }

  void read(TableReader& reader, Protocol&) override {
    reader.number("unbalanced", stage.unbalanced, "1", ratio, "unbalanced force ratio below which the stage ends");
    reader.whole_number("max_steps", stage.max_steps, steps, "most sub-steps; then the stage fails");
    reader.boolean("record", stage.record, "records the state before and after");
  }

  std::size_t planned_records() const override { return stage.record ? 2 : 0; }

  void drive(RunningTest& test) const override {
    if (test.run.progress.phase == std::int32_t(RelaxPhase::begun)) {
      if (stage.record) test.record_now(0);
      test.run.progress.phase = std::int32_t(RelaxPhase::relaxing);
    }
    const Report report = test.relax(stage.unbalanced, stage.max_steps);
    if (report.unbalanced_ratio > stage.unbalanced) {
      TextStream text;
      text << "the unbalanced ratio is " << report.unbalanced_ratio << " after " << report.substeps
           << " steps; wanted: " << stage.unbalanced << "; raise max_steps or unbalanced";
      throw test.failed(text.str());
    }
    if (stage.record) test.record_now(0);
  }
};

}  // namespace

std::unique_ptr<StageKind> relax_kind() { return std::make_unique<Relax>(); }

}  // namespace rvelab::protocol
