// The output of `rvelab fit`.
#pragma once

#include <string>
#include <vector>

#include "rvelab/cli/fit_tests.hpp"
#include "rvelab/fit/search.hpp"

namespace rvelab::cli {

struct FitOutcome {
  std::vector<fit::Target> targets;
  fit::Finding finding;
  std::vector<FitResult> results;      ///< of the candidates
  std::vector<FitResult> predictions;  ///< of all tests, at points of the posterior
  double wall_seconds = 0;
};

/// Prints the posterior and writes to the folder fit.json, fit.csv (one row per test), for measured curves curves.csv,
/// and for predictions predictions.csv.
void report_fit(const FitSetup& setup, const FitOutcome& outcome, const std::string& folder, bool json);

/// Measurements and predictions with the fitted parameters: a table, rows of predictions.csv, and "predictions" of
/// fit.json. A deviation is over sqrt(e^2 + s^2), the standard error of the measurement and the scatter of the
/// predictions (specimens and parameters).
std::string predictions_text(const FitSetup& setup, const std::vector<FitResult>& predictions);
std::string predictions_csv(const FitSetup& setup, const std::vector<FitResult>& predictions);
Json predictions_json(const FitSetup& setup, const std::vector<FitResult>& predictions);

/// The same of features: a table, the columns of features.csv, and "features" of fit.json.
std::string features_text(const FitSetup& setup, const std::vector<FitResult>& predictions);
std::string features_csv(const FitSetup& setup, const std::vector<FitResult>& predictions);
Json features_json(const FitSetup& setup, const std::vector<FitResult>& predictions);

/// Prints means and standard errors over the specimens at each point, and writes sweep.csv to the folder.
void report_sweep(const FitSetup& setup, const std::vector<FitTest>& tests, const std::vector<FitResult>& results,
                  const std::string& folder, bool json);

}  // namespace rvelab::cli
