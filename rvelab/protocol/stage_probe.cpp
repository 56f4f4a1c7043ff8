// Probe stages: the stiffness of the state as it is, measured on copies; the test itself is not moved. Declared in
// stage_kinds.hpp.
#include "rvelab/error.hpp"
#include "rvelab/keys/table_reader.hpp"
#include "rvelab/measure/probe.hpp"
#include "rvelab/measure/tangent.hpp"
#include "rvelab/protocol/drive.hpp"
#include "rvelab/protocol/stage_kinds.hpp"

namespace rvelab::protocol {
namespace {

using namespace keys;

struct StiffnessProbe : KindOf<ProbeStage> {
  const char* name() const override { return "probe"; }
  bool takes_events() const override { return false; }

  void read(TableReader& reader, Protocol&) override {
    reader.choice("method", stage.method, {"dynamic", "linear"},
                  "dynamic: increments of +-size, relaxed; linear: the contact network solved, every contact stuck");
    reader.number("size", stage.size, "1", {smallest_probe, 0.01}, "method = dynamic: strain of each increment");
    stage.no_slip = stage.method == ProbeStage::Method::linear;
    reader.boolean("no_slip", stage.no_slip, "no contact slips or rolls over in the probed copy (friction 1e6)",
                   "(true with method = linear, else false)");
    if (stage.method == ProbeStage::Method::linear && !stage.no_slip)
      reader.mistake("no_slip",
                     "contradicts method = \"linear\", in which every contact is stuck; allowed: true with it; remove "
                     "the key or take method = \"dynamic\"");
  }

  void drive(RunningTest& test) const override {
    if (stage.method == ProbeStage::Method::linear) {
      test.probed(elastic_tangent(test.rve.network()));
      return;
    }
    Rve copy(test.rve);
    if (stage.no_slip) forbid_slip(copy);
    const Probe probe = probe_stiffness(copy, stage.size);
    if (!probe.relaxed) {
      throw test.failed("the probes relaxed to the unbalanced ratio " + in_words(probe.unbalanced_ratio) +
                        " only; allowed: below " + in_words(relaxed_ratio) +
                        "; give a relax stage before, another size, or method = \"linear\"");
    }
    test.probed(probe.stiffness);
  }
};

}  // namespace

std::unique_ptr<StageKind> probe_kind() { return std::make_unique<StiffnessProbe>(); }

}  // namespace rvelab::protocol
