// The input of `rvelab fit`: one protocol with targets on the command line, or a file of several measured tests.
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

/// The complete, checked setup before the first test. Arguments that were not given (tests) get the values of the file.
/// InputError for an error in either.
FitSetup setup_of(FitArguments& arguments);

}  // namespace rvelab::cli
