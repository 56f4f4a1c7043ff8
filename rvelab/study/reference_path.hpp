// The best-resolved path: the test once with the reference settings, states of it kept at even distances, each with the
// deformation that the path made from there.
//
// Two runs that differ in one bit differ by per cents of the stress after some strain, so whole paths cannot be
// compared. Increments can: each starts from a state of this path.
#pragma once

#include <cstdint>
#include <vector>

#include "rvelab/protocol/run.hpp"

namespace rvelab::study {

/// A state of the path, and what the path did next.
struct PathState {
  Specimen state;
  std::int32_t stage = 0;                           ///< row of the protocol's stages
  double strain = 0;                                ///< the stage's driving strain at the state
  Matrix3 displacement_gradient = Matrix3::Zero();  ///< that the path made from here, over `records` of its records
  double time = 0;                                  ///< s, that it took; 0: quasi-static
  long records = 1;
};

struct ReferencePath {
  protocol::TestRun run;
  std::vector<PathState> states;
};

/// Records that each stage of a protocol makes where no event ends it, less the first: its increments.
std::vector<std::size_t> increments_of_stages(const protocol::Protocol& protocol);

/// Records of the reference that one increment of the coarsest of the protocols spans, for each stage (1 or more).
std::vector<long> longest_increments(const protocol::Protocol& reference,
                                     const std::vector<protocol::Protocol>& protocols);

/// Increments that a protocol makes while the reference makes `records` of its own in a stage, 1 or more.
long parts_of(const protocol::Protocol& protocol, const protocol::Protocol& reference, std::int32_t stage,
              long records);

/// Runs the path and keeps `count` states of it, or as many as there are; 0: none. `spans`: records from a state to the
/// end of its increment, for each stage. The states do not depend on what watches. Error if the path cannot be run, or
/// has no increment although one is asked for.
ReferencePath reference_path(const protocol::Protocol& protocol, const Specimen& specimen, std::size_t count,
                             const std::vector<long>& spans, protocol::Watch watch);

}  // namespace rvelab::study
