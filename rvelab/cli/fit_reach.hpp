// Checks that the tests of a fit cover the measured curves.
#pragma once

#include "rvelab/cli/fit_tests.hpp"
#include "rvelab/ensemble/features.hpp"
#include "rvelab/protocol/protocol.hpp"

namespace rvelab::cli {

/// InputError for a curve that begins before or ends after the stage with which it is compared, if the protocol gives
/// begin and end of the stage: no test could reproduce its points.
void expect_reach(const ComparedTest& compared, const protocol::Protocol& protocol);
/// InputError for a feature at a strain beyond the end of the last stage.
void expect_reach(const ensemble::Feature& feature, const protocol::Protocol& protocol);

}  // namespace rvelab::cli
