// The rows of a path: which constraints they make together, and what they ask at each of its records. Internal to the
// module.
#pragma once

#include <string>

#include "rvelab/protocol/drive.hpp"
#include "rvelab/protocol/protocol.hpp"
#include "rvelab/solver/rve.hpp"

namespace rvelab::protocol {

/// What is wrong with the rows as one set of constraints on a specimen of this dimension, in words that name the rows:
/// their number, rows that follow from others, rows that contradict others, rows that leave a strain open. Empty: they
/// are good.
std::string mistake_of_rows(const PathStage& stage, int dimension);

/// What an increment adds to the sum of strains: the deviator of the symmetric displacement gradient, and the logarithm
/// of its change of volume.
Matrix3 strain_increment(const Matrix3& displacement_gradient, int dimension);

/// One increment for each record, from the start of the stage or on from where it was left.
void follow_path(RunningTest& test, const PathStage& stage);

/// Records of the whole path, the first included.
std::size_t path_records(const PathStage& stage);

}  // namespace rvelab::protocol
