// The tests of `rvelab fit`: protocols with the varied keys, on specimens that are given or packed for each test. What
// a test gave lies in a file of its own, so that a fit that was killed goes on with the tests that are missing.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "rvelab/cli/report.hpp"
#include "rvelab/ensemble/measures.hpp"
#include "rvelab/fit/curve.hpp"
#include "rvelab/fit/parameters.hpp"
#include "rvelab/specimen/specimen.hpp"

namespace rvelab::cli {

/// A test that each set of parameters makes, and what was measured in it.
struct ComparedTest {
  std::string name;                   ///< ""; of a file of several tests: its own
  std::string protocol;               ///< path
  std::vector<std::string> settings;  ///< KEY=value of it alone
  double pressure = 0;                ///< Pa; 0: that of the protocol
  std::vector<fit::ScalarTarget> targets;
  std::vector<fit::Curve> curves;
  bool predict = false;  ///< not fitted
};

/// What every test of a fit has in common, and the tests.
struct FitSetup {
  std::vector<std::string> settings;  ///< --set
  std::string recipe;                 ///< path; "": the specimens are given
  std::vector<std::string> files;     ///< of the specimens
  std::vector<Specimen> specimens;
  std::size_t specimen_count = 0;  ///< of the recipe: seeds from its own on
  bool same_specimens = false;     ///< the targets were measured on the given specimens
  std::vector<fit::Parameter> parameters;
  std::vector<ComparedTest> tests;
  bool predicts = false;  ///< all tests are made once more with the parameters found

  bool has_targets() const;
  bool has_curves() const;
};

/// The tests of one set of parameters, to be made.
struct FitTest {
  std::size_t number = 0;
  Eigen::VectorXd values;  ///< of the parameters
  std::size_t specimen = 0;
  bool predicting = false;  ///< those that are not fitted too
};

/// What they gave.
struct FitResult {
  std::vector<std::vector<double>> measures;  ///< of ensemble::measures(), for each test that was made
  std::vector<std::vector<double>> curves;    ///< one after the other over these tests
  std::vector<fit::Features> features;        ///< of the curves
  std::string failure;                        ///< why one could not be carried out; "": all were
};

/// A measure of the test that was made as number `made`.
double measure_of(const FitResult& result, std::size_t made, const std::string& measure);

/// InputError for a key that neither protocol nor recipe takes, at both ends of every range, and for a specimen that
/// does not go with the protocol; and for a curve that leaves its test (fit_reach.hpp).
void expect_runnable(const FitSetup& setup);

/// Makes them, `threads` sets at a time; those whose file is in `folder` are read. Without a folder nothing is kept.
/// Exit after a signal.
std::vector<FitResult> made(const FitSetup& setup, const std::vector<FitTest>& tests, const std::string& folder,
                            unsigned threads, std::size_t planned);

}  // namespace rvelab::cli
