// What a study gives, as JSON, as CSV and as tables on a terminal.
#pragma once

#include <string>

#include "rvelab/cli/report.hpp"
#include "rvelab/study/summary.hpp"

namespace rvelab::cli {

/// One object: the study, the measures and what they mean, the reference, and the grid points in their order.
Json as_json(const study::Study& study, const study::StudySummary& summary);

/// A header and one line a run, the reference first.
std::string as_csv(const study::Study& study, const study::StudySummary& summary);

/// The errors and costs of the increments, and the measures of the whole paths, one line a run each.
std::string as_tables(const study::Study& study, const study::StudySummary& summary);

}  // namespace rvelab::cli
