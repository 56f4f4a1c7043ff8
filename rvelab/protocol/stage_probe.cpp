// Probe stages: the stiffness of the state as it is, measured on copies; the test itself is not moved. Declared in
// stage_kinds.hpp.
#include "rvelab/error.hpp"
#include "rvelab/keys/table_reader.hpp"
#include "rvelab/measure/probe.hpp"
#include "rvelab/measure/tangent.hpp"
#include "rvelab/protocol/drive.hpp"
#include "rvelab/protocol/stage_kinds.hpp"
#include "rvelab/records/loading_direction.hpp"

namespace rvelab::protocol {
namespace {

using namespace keys;

struct StiffnessProbe : KindOf<ProbeStage> {
  const char* name() const override { return "probe"; }
  bool takes_events() const override { return false; }

  void read(TableReader& reader, Protocol&) override {
    reader.choice("method", stage.method, {"dynamic", "linear", "loading"},
                  "dynamic: increments of +-size, relaxed; linear: the contact network solved, every contact stuck; "
                  "loading: increments that go on in the direction of the records before");
    if (stage.method == ProbeStage::Method::loading) stage.size = usual_loading_probe;
    reader.number(
        "size", stage.size, "1", {smallest_probe, 0.01},
        "strain of each increment; method = linear: none; loading: at least 1e-5, 1e-3 where it is not given");
    if (stage.method == ProbeStage::Method::loading && stage.size < smallest_loading_probe)
      reader.mistake("size", in_words(stage.size) + " is out of range with method = \"loading\"; allowed: " +
                                 in_words(smallest_loading_probe) + " to 0.01; give 1e-3");
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
    if (stage.method == ProbeStage::Method::loading) {
      const Matrix3 direction = records::loading_direction(test.run.result.records);
      if (direction.isZero(0))
        throw test.failed("method = \"loading\" needs a direction; give a stage before that deforms and records");
      test.probed(loading_stiffness(copy, direction, stage.size));
      return;
    }
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
