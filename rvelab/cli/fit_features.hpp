// Features of the tests of `rvelab fit` (fit/measured_features.hpp): which are compared, and how they came out.
#pragma once

#include <string>
#include <vector>

#include "rvelab/cli/fit_tests.hpp"

namespace rvelab::cli {

/// Fills in the features of each test: of its curve and of repeated ones, and those that targets name, which are taken
/// out of the targets. Says which the curves do not have, and what repeated tests scatter. InputError for one that the
/// test cannot give: beyond its end, of a column that the curve does not have.
void take_features(FitSetup& setup);

/// Features as measured and as predicted: a table, and a JSON list; the columns of features.csv.
std::string features_text(const FitSetup& setup, const std::vector<FitResult>& predictions);
std::string features_csv(const FitSetup& setup, const std::vector<FitResult>& predictions);
Json features_json(const FitSetup& setup, const std::vector<FitResult>& predictions);

}  // namespace rvelab::cli
