// A run of rvelab-mpm as a page tells it: curves of its history.csv, points coloured by what they hold, rocks.
#pragma once

#include <string>

#include "rvelab/report/json.hpp"

namespace rvelab::report {

/// Whether a folder is one that rvelab-mpm wrote.
bool is_mpm_run(const std::string& folder);

struct MpmRun {
  Json json;
  std::size_t states = 0;
};
/// `largest`: bytes that its states may take; then they are every n-th frame and the last. InputError: a file of it
/// cannot be read.
MpmRun read_mpm_run(const std::string& folder, double largest);

}  // namespace rvelab::report
