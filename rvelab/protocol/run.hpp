// A protocol run on a specimen: every stage through Rve::apply, every record at its strain.
//
// This room drives and records; the servo and all error control are inside Rve::apply.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "rvelab/protocol/protocol.hpp"
#include "rvelab/protocol/record.hpp"

namespace rvelab {

/// What a probe stage measured: stiffness as elastic_tangent() gives it (rvelab/measure/tangent.hpp), Pa.
struct ProbeResult {
  std::string stage;
  Eigen::MatrixXd stiffness;
};

struct TestRun {
  TestResult result;
  Specimen end_state;
  std::vector<ProbeResult> probes;
};

/// Called after each record, on the calling thread.
using OnRecord = std::function<void(const Record&)>;

/// Runs all stages in order. Records lie at the fixed strains of their stage, none skipped or delayed; a record whose
/// held stress was not reached within the wait is kept and flagged (target_held = false). Throws InputError if
/// specimen and protocol do not go together; Error (IncrementFailed among them) if a stage cannot be carried out,
/// naming the stage and what was reached.
TestRun run_protocol(const Protocol& protocol, const Specimen& specimen, const OnRecord& on_record = {});

}  // namespace rvelab
