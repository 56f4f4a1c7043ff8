// Features of the tests of `rvelab fit` (fit/measured_features.hpp): which are compared.
#pragma once

#include "rvelab/cli/fit_tests.hpp"

namespace rvelab::cli {

/// Fills in the features of each test: of its curve and of repeated ones, and those that targets name, which are taken
/// out of the targets. Says which the curves do not have, and what repeated tests scatter. InputError for one that the
/// test cannot give: beyond its end, of a column that the curve does not have.
void take_features(FitSetup& setup);

}  // namespace rvelab::cli
