// The tests of `rvelab fit`: protocols with the varied keys, on specimens that are given or packed for each test. What
// a test gave lies in a file of its own, so that a fit that was killed goes on with the tests that are missing.
#pragma once

#include <Eigen/Core>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "rvelab/cli/report.hpp"
#include "rvelab/ensemble/measures.hpp"
#include "rvelab/fit/curve.hpp"
#include "rvelab/fit/measured_features.hpp"
#include "rvelab/fit/parameters.hpp"
#include "rvelab/fit/soil_file.hpp"
#include "rvelab/protocol/protocol.hpp"
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

  bool by_features = false;                          ///< of the curves features are fitted, not the points
  std::vector<std::string> feature_names;            ///< that were asked for; empty: the usual ones
  std::vector<std::vector<fit::Curve>> repetitions;  ///< curves of each repeated test
  std::vector<fit::MeasuredFeature> features{};      ///< of curves, and those that targets give
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
  std::optional<fit::SandLimits> sand;

  bool has_targets() const;
  bool has_curves() const;  ///< whose points are fitted, or predicted
  bool has_features() const;
  std::size_t fitted_tests() const;
};

/// Begins a key that is of one test alone: "measured.NAME.target.relative_density".
inline const std::string of_one_test = "measured.";

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
  std::vector<std::vector<double>> compared;  ///< features of each test (ComparedTest::features)
  std::string failure;                        ///< why one could not be carried out; "": all were
};

/// A measure of the test that was made as number `made`.
double measure_of(const FitResult& result, std::size_t made, const std::string& measure);

/// The protocol of a test with these values of the parameters.
protocol::Protocol protocol_of(const FitSetup& setup, const ComparedTest& compared, const Eigen::VectorXd& values);

/// InputError for a key that neither protocol nor recipe takes, at both ends of every range, and for a specimen that
/// does not go with the protocol; and for a curve that leaves its test (fit_reach.hpp).
void expect_runnable(const FitSetup& setup);

/// Says once what a fit takes: after the first sets of parameters, before the long part.
class CostNotice {
 public:
  CostNotice(const FitSetup& setup, std::size_t sets, unsigned threads);
  /// A set was made, on any thread: s in all, and for packing.
  void took(double seconds, double packing);

 private:
  const FitSetup& setup_;
  const std::size_t sets_, lanes_;
  std::mutex mutex_;
  std::size_t made_ = 0;
  double seconds_ = 0, packing_ = 0;
};

/// Makes them, `threads` sets at a time; those whose file is in `folder` are read. Without a folder nothing is kept.
/// Exit after a signal.
std::vector<FitResult> made(const FitSetup& setup, const std::vector<FitTest>& tests, const std::string& folder,
                            unsigned threads, std::size_t planned, CostNotice* cost = nullptr);

}  // namespace rvelab::cli
