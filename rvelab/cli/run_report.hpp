// What `rvelab run` prints: warnings before a test, its results after it.
#pragma once

#include <string>

#include "rvelab/protocol/run.hpp"

namespace rvelab::cli {

/// Warns of a stage of simple shear that makes the cell of this specimen too thin.
void tell_of_shear(const protocol::Protocol& protocol, const Specimen& specimen);

/// Prints the results, and warnings of doubtful ones. `wall`: s, of this run; a continued test has run longer.
/// `output`: the record file; empty: none.
void report_run(const protocol::Protocol& protocol, const protocol::TestRun& run, double wall,
                const std::string& output, bool json);

}  // namespace rvelab::cli
