#include "rvelab/protocol/run.hpp"

#include <chrono>

#include "rvelab/error.hpp"
#include "rvelab/protocol/drive.hpp"

namespace rvelab {

TestRun run_protocol(const Protocol& protocol, const Specimen& specimen, const OnRecord& on_record) {
  const auto begin = std::chrono::steady_clock::now();
  protocol::RunningTest test(protocol, with_overrides(protocol, specimen), on_record);
  const auto steps_before = test.rve.grain_steps();
  test.run.result.protocol = protocol.name;
  for (const Stage& stage : protocol.stages) {
    test.begin_stage(stage);
    std::visit([&](const auto& what) { protocol::drive(test, what); }, stage.what);
  }
  test.run.result.grain_steps = test.rve.grain_steps() - steps_before;
  test.run.result.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  test.run.end_state = test.rve.specimen();
  return std::move(test.run);
}

}  // namespace rvelab
