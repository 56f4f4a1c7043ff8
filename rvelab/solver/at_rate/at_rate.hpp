// Loading at a rate (dt > 0): physical masses, sub-steps of the critical step and of the collisions ahead.
#pragma once

#include "rvelab/solver/loading/mixed_target.hpp"
#include "rvelab/solver/state/state.hpp"

namespace rvelab {

/// An increment over the time dt, s. Throws IncrementFailed.
Report load_at_rate(State& state, const FrameSplit& increment, double dt);

/// A mixed target over the time dt, no more: `gradient` is what was found. A stress that is missed is no error:
/// Report::target_held says so.
Report load_at_rate(State& state, const MixedTarget& target, double dt, Matrix3& gradient);

}  // namespace rvelab
