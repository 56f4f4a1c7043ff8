// What `rvelab fit` prints and writes.
#pragma once

#include <string>
#include <vector>

#include "rvelab/cli/fit_tests.hpp"
#include "rvelab/fit/search.hpp"

namespace rvelab::cli {

struct FitOutcome {
  std::vector<fit::Target> targets;
  fit::Finding finding;
  std::vector<FitResult> results;  ///< of the trials
  double wall_seconds = 0;
};

/// Prints the posterior; into the folder go fit.json, fit.csv (one row a test) and, with measured curves, curves.csv.
void report_fit(const FitSetup& setup, const FitOutcome& outcome, const std::string& folder, bool json);

/// Prints means and standard errors over the specimens at each point; sweep.csv goes into the folder.
void report_sweep(const FitSetup& setup, const std::vector<FitTest>& tests, const std::vector<FitResult>& results,
                  const std::string& folder, bool json);

}  // namespace rvelab::cli
