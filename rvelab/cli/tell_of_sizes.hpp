// A question that spares a user a factor of a thousand.
#pragma once

#include "rvelab/cli/report.hpp"

namespace rvelab::cli {

/// Asks on standard error whether millimetres were meant, where the grains are of metres and do not press each other.
void tell_of_sizes(const Sizes& sizes);

}  // namespace rvelab::cli
