// What a soil is (ensemble/features.hpp) by the curves of a laboratory, each feature with its error: the scatter of
// laboratories over the root of the number of tests that were made of one kind.
//
// Scatter: the assumed one of a feature times a factor for all features of its quantity, which repeated tests give,
//   f^2 = (4 + sum z^2)/(4 + sum (n - 1))     z: (value - mean of the n tests)/assumed scatter at the mean
// with sums over the kinds of test of means over their features, since these go together: the assumption counts as four
// repetitions (scale of a scaled inverse chi-square posterior of the variance).
#pragma once

#include <map>
#include <string>
#include <vector>

#include "rvelab/ensemble/features.hpp"
#include "rvelab/fit/curve.hpp"
#include "rvelab/fit/search.hpp"

namespace rvelab::fit {

struct MeasuredFeature {
  ensemble::Feature feature;
  double value = 0, error = 0;  ///< mean of the tests, and its standard error
  std::vector<double> tests{};  ///< value of each
};

/// The curves of one test.
ensemble::TestPath path_of(const std::vector<Curve>& curves);

/// The features of a test and its repetitions (curves of each), as far as the first has them: q, p over a strain up to
/// the largest q. Errors are those of `factor` = 1. `left_out`: names of the others.
std::vector<MeasuredFeature> measured_features(const std::vector<ensemble::Feature>& features,
                                               const std::vector<std::vector<Curve>>& tests,
                                               std::vector<std::string>& left_out);

/// f of each quantity of which there are repeated tests.
std::map<std::string, double> scatter_factors(const std::vector<std::vector<MeasuredFeature>>& tests);

/// As targets, those of one quantity as a group of one number, from `number` on, which goes on to the next.
std::vector<Target> targets_of(const std::vector<MeasuredFeature>& features, int& number, const std::string& test);

}  // namespace rvelab::fit
