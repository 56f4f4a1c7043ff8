// Measured and calculated tests side by side: the curves that are compared, and how far they are apart.
#pragma once

#include <string>
#include <vector>

#include "tools/models/element.hpp"

namespace rvelab::models {

/// A quantity of a test, row by row, and what a deviation is divided by.
struct Curve {
  std::vector<double> values, scale;
};

/// What a fit compares: drained q and eps_v; undrained q and p; oedometer eps_a and q; isotropic eps_v; cyclic shear
/// the shear stress, relative row by row where the test has no reversal.
std::vector<Curve> curves_of(const ElementTest& test);

/// Without rows that are not finite, which a remark counts; no rows if fewer than 5 stay. p0 that is not given is that
/// of the first row. InputError: columns of different lengths, no p0, no e0.
ElementTest without_gaps(const ElementTest& test, std::vector<std::string>& remarks);

/// About forty rows, among them all at which the test turns round.
ElementTest thinned(const ElementTest& test);

/// A drained test until twice the strain of its largest q, others whole.
ElementTest around_the_peak(const ElementTest& test);

Misfit misfit(const ElementTest& measured, const Calculation& calculated);

}  // namespace rvelab::models
