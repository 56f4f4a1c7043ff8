// Mohr circles of the peaks and the friction angle of each set of tests, as the ensemble gives it.
#pragma once

#include "rvelab/report/tables.hpp"

namespace rvelab::report {

/// One entry a set that leads to a strength: circles, angle, cohesion, interval, and the sentence that says them. The
/// angle is the mean over the specimens of that which rvelab run prints.
Json strength_of(const std::vector<Test>& tests, const std::vector<Kind>& kinds, const Results& results);

}  // namespace rvelab::report
