// The largest frequency of the contacts with physical masses, from below.
#pragma once

#include "rvelab/solver/assembly/assembly.hpp"

namespace rvelab {

/// A frequency (rad/s) that some motion of the grains has, by the power method on M^-1 K: at most the largest one, and
/// of small networks within 2 % of it. K holds the springs of the contacts as they are (loading/inertia.hpp), not the
/// dashpots; of grains that are not round the translations only. A time step beyond 2 over it is unstable for certain,
/// one beyond that of the row sums need not be. 0 without contacts. It takes as long as some hundred sub-steps.
double frequency_reached(const Model& model, const Assembly& assembly);

}  // namespace rvelab
