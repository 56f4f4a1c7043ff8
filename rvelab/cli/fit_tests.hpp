// The tests of `rvelab fit`: a protocol with the varied keys, on specimens that are given or packed for each test. What
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

/// A measured curve, and the pressure that it was measured at.
struct MeasuredCurve {
  fit::Curve curve;
  double pressure = 0;  ///< Pa; 0: that of the protocol
};

/// What every test of a fit has in common.
struct FitSetup {
  std::string protocol;               ///< path
  std::vector<std::string> settings;  ///< --set
  std::string recipe;                 ///< path; "": the specimens are given
  std::vector<std::string> files;     ///< of the specimens
  std::vector<Specimen> specimens;
  std::size_t specimen_count = 0;  ///< of the recipe: seeds from its own on
  bool same_specimens = false;     ///< the targets were measured on the given specimens
  std::vector<fit::Parameter> parameters;
  std::vector<fit::ScalarTarget> targets;
  std::vector<MeasuredCurve> curves;
  std::vector<double> pressures;  ///< of each test; 0: that of the protocol

  std::size_t pressure_number(double pressure) const;
};

/// One test to make.
struct FitTest {
  std::size_t number = 0;
  Eigen::VectorXd values;  ///< of the parameters
  std::size_t specimen = 0;
};

/// What it gave.
struct FitResult {
  std::vector<std::vector<double>> measures;  ///< of ensemble::measures(), for each pressure
  std::vector<std::vector<double>> curves;
  std::string failure;  ///< why it could not be carried out; "": it was
};

/// InputError for a key that neither protocol nor recipe takes, at both ends of every range, and for a specimen that
/// does not go with the protocol.
void expect_runnable(const FitSetup& setup);

/// Makes the tests, `threads` at a time; those whose file is in `folder` are read. Without a folder nothing is kept.
/// Exit after a signal.
std::vector<FitResult> made(const FitSetup& setup, const std::vector<FitTest>& tests, const std::string& folder,
                            unsigned threads, std::size_t planned);

}  // namespace rvelab::cli
