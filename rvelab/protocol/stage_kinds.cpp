#include "rvelab/protocol/stage_kinds.hpp"

#include <algorithm>
#include <stdexcept>

#include "rvelab/error.hpp"
#include "rvelab/protocol/drive.hpp"

namespace rvelab::protocol {
const StageKind& kind_named(const std::string& name) {
  const auto& all = stage_kinds();
  const auto found = std::find_if(all.begin(), all.end(), [&](const StageKind& kind) { return kind.name == name; });
  if (found == all.end()) throw std::logic_error("no kind of stage is called \"" + name + "\" in stage_kinds.hpp");
  return *found;
}

std::string kinds_with_events(bool taking) {
  std::string names;
  for (const StageKind& kind : stage_kinds()) {
    if (kind.takes_events == taking) names += (names.empty() ? "" : ", ") + kind.name;
  }
  return names;
}

void drive(RunningTest& test, const Stage& stage) { kind_named(stage.kind).drive(test, stage.what); }

void expect_fits(const Protocol& protocol, int dimension) {
  for (const Stage& stage : protocol.stages) {
    const std::string mistake = kind_named(stage.kind).misfit(stage.what, dimension);
    if (!mistake.empty()) throw InputError(protocol.path + ": stage \"" + stage.name + "\": " + mistake);
  }
}

std::size_t planned_records(const Protocol& protocol) {
  std::size_t count = 0;
  for (const Stage& stage : protocol.stages) count += kind_named(stage.kind).planned_records(stage.what);
  return count;
}

StageRole role_of(const Stage& stage) { return kind_named(stage.kind).role(stage.what); }

std::string strength_stages() {
  std::string text;
  for (const auto& kind : stage_kinds()) {
    if (kind.strength_when.empty()) continue;
    text += (text.empty() ? "" : "; or ") + ("kind = \"" + kind.name + "\" with " + kind.strength_when);
  }
  return text;
}

}  // namespace rvelab::protocol
