// The file of a fit of several measured tests on one soil: [fit] and [[measured]].
#pragma once

#include <toml++/toml.h>

#include <optional>
#include <string>
#include <vector>

#include "rvelab/fit/curve.hpp"
#include "rvelab/fit/parameters.hpp"

namespace rvelab::fit {

/// A test of a laboratory, as the file names it.
struct MeasuredTest {
  std::string name;
  std::string protocol;                    ///< path, or the name of an installed one
  std::string curve;                       ///< path relative to the file; "": none
  Selection selection;                     ///< of its columns and rows
  std::vector<ScalarTarget> targets;       ///< MEASURE=value, without a pressure
  std::optional<double> pressure;          ///< Pa: of the specimen and of the test
  std::optional<double> relative_density;  ///< of the specimen
  std::optional<double> void_ratio;        ///< of the specimen
  std::vector<std::string> settings;       ///< KEY=value of this test alone
  bool predict = false;                    ///< not fitted: compared with what the fit predicts
  std::string compare;                     ///< "curves", "features"; "": as the file says
  std::vector<std::string> features;       ///< names; empty: the usual ones, where features are compared
  std::string repeats;                     ///< name of the test that this one repeats in the laboratory; "": none
};

/// Densest and loosest void ratio of the sand itself.
struct SandLimits {
  double e_min = 0, e_max = 0;
};

struct SoilFile {
  std::string recipe;  ///< path relative to the file, or the name of an installed one
  long count = 5;      ///< specimens
  std::optional<long> tests;
  enum class Compare { curves, features } compare = Compare::curves;
  /// With them void ratios of tests are those of the sand, whose relative density the specimen gets.
  std::optional<SandLimits> sand;
  std::vector<std::string> settings;  ///< KEY=value of all tests
  std::vector<Parameter> parameters;
  std::vector<MeasuredTest> measured;

  bool compares_features(const MeasuredTest& test) const {
    if (!test.compare.empty()) return test.compare == "features";
    return compare == Compare::features || !test.features.empty();
  }
  /// Settings of a test, with those that pressure and density stand for.
  std::vector<std::string> assignments(const MeasuredTest& test) const;
};

bool is_soil_file(const toml::table& file);
/// InputError with every mistake and its line; `path` serves messages.
SoilFile read_soil_file(const toml::table& file, const std::string& path);

}  // namespace rvelab::fit
