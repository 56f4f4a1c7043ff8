// Mohr circles of the peaks and the friction angle of each set of tests, from the ensemble.
#pragma once

#include "rvelab/report/tables.hpp"

namespace rvelab::report {

/// One entry for each set with a strength: circles, angle, cohesion, interval, and a sentence with these values. The
/// angle is the mean over the specimens of the angle that rvelab run prints.
Json strength_of(const std::vector<Test>& tests, const std::vector<Kind>& kinds, const Results& results);

}  // namespace rvelab::report
