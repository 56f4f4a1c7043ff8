// Probe stages: the stiffness of the state as it is, measured on copies; the test itself is not moved.
#include "rvelab/error.hpp"
#include "rvelab/measure/probe.hpp"
#include "rvelab/measure/tangent.hpp"
#include "rvelab/protocol/drive.hpp"

namespace rvelab::protocol {

void drive(RunningTest& test, const ProbeStage& stage) {
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

}  // namespace rvelab::protocol
