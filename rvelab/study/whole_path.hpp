// Whole paths: the test on a specimen moved by next to nothing, and what it is judged by.
#pragma once

#include <cstdint>

#include "rvelab/protocol/run.hpp"
#include "rvelab/study/piece.hpp"

namespace rvelab::study {

/// The specimen with every position moved by up to 1e-10 of the grain's radius in each direction of its space: enough
/// for a path of its own, far too little to be another specimen. The first repeat, 1, is the specimen as it is; the
/// same repeat is moved in the same way always.
Specimen perturbed(Specimen specimen, std::uint64_t repeat);

/// What a path gives: each measure by its name, "seconds" of processor time and "grain_steps".
Piece measured_path(const protocol::TestRun& run, double seconds);

/// Runs the path. What cannot be carried out is the piece's failure, and all its measures are NaN; InputError and
/// Interrupted are thrown.
Piece whole_path(const protocol::Protocol& protocol, const Specimen& specimen, const protocol::Watch& watch);

}  // namespace rvelab::study
