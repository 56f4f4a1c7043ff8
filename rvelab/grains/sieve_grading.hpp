// A grading curve from the three diameters that a soil report gives.
#pragma once

#include <limits>
#include <string>

#include "rvelab/grains/grading.hpp"

namespace rvelab {

/// Curve by mass, straight on the semi-logarithmic sheet between (d10, 10 %), (d50, 50 %) and (d60, 60 %); below d10 it
/// goes on at the slope of d10 to d50, above d60 at the slope of d10 to d60. Diameters in m, 0 < d10 < d50 < d60, or
/// all equal for grains of one size. A table of radii, made without libm.
Grading sieve_grading(double d10, double d50, double d60);

/// What is wrong with three diameters, with what is allowed; "": nothing. d50 must not lie off the straight line from
/// d10 to d60 by more than a factor of 1.5, and the largest grain is at most 100 times the smallest, of what scalping
/// below and above two diameters (m) leaves.
std::string wrong_with_sieves(double d10, double d50, double d60, double scalp_below = 0,
                              double scalp_above = std::numeric_limits<double>::infinity());

}  // namespace rvelab
