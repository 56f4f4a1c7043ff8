// A run of rvelab-mpm in a page: curves of its history.csv, points coloured by their fields, rocks.
#pragma once

#include <string>

#include "rvelab/report/json.hpp"

namespace rvelab::report {

/// Whether rvelab-mpm wrote the folder.
bool is_mpm_run(const std::string& folder);

struct MpmRun {
  Json json;
  std::size_t states = 0;
};
/// `largest`: limit of the bytes of its states; above it every n-th frame and the last are kept. InputError: a file of
/// it cannot be read.
MpmRun read_mpm_run(const std::string& folder, double largest);

}  // namespace rvelab::report
