// Whether the tests of a fit go as far as the curves that were measured.
#pragma once

#include "rvelab/cli/fit_tests.hpp"
#include "rvelab/protocol/protocol.hpp"

namespace rvelab::cli {

/// InputError for a curve that begins before or ends behind the stage it is compared with, as far as the protocol says
/// where that begins and ends: no test could give its points.
void expect_reach(const ComparedTest& compared, const protocol::Protocol& protocol);

}  // namespace rvelab::cli
