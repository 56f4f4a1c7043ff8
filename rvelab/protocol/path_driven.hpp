// A test driven along the rows of a path (path_rows.hpp): paths, and kinds of stages that are paths of certain rows.
// Internal to the room.
#pragma once

#include "rvelab/protocol/drive.hpp"
#include "rvelab/protocol/path_rows.hpp"

namespace rvelab::protocol {

/// One increment for each record, from the start of the stage or on from where it was left.
void follow_path(RunningTest& test, const PathStage& stage);

/// Records of the whole path, the first included.
std::size_t path_records(const PathStage& stage);

}  // namespace rvelab::protocol
