// What `rvelab fit` is asked for: one protocol with targets on the command line, or a file of several measured tests.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rvelab/cli/fit_tests.hpp"

namespace rvelab::cli {

struct FitArguments {
  std::string what;  ///< a protocol, or a file of several tests (fit/soil_file.hpp)
  std::vector<std::string> specimens, more, settings, vary, targets, curves, columns, predict;
  std::optional<std::string> recipe;
  std::optional<long> count, tests, batch;
  std::string folder;
  unsigned threads = 0;
  bool same_specimens = false, force = false, resume = false, json = false;
};

/// The setup, checked: all of it is known before the first test. Takes what a file says of `arguments` that were not
/// given (tests) into them. InputError for a mistake of either.
FitSetup setup_of(FitArguments& arguments);

}  // namespace rvelab::cli
