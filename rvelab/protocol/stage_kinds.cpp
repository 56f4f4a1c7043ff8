#include "rvelab/protocol/stage_kinds.hpp"

#include <stdexcept>

#include "rvelab/error.hpp"
#include "rvelab/protocol/drive.hpp"

namespace rvelab::protocol {

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

void expect_fits(const Protocol& protocol, int dimension) {
  for (const Stage& stage : protocol.stages) {
    const std::string mistake = stage.what->misfit(dimension);
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

}  // namespace rvelab::protocol
