// The sub-step at dt > 0: the critical step of the contacts, and the collisions ahead.
#pragma once

#include "rvelab/solver/state/state.hpp"

namespace rvelab {

struct TimeStep {
  double longest = 0;  ///< s
  long interval = 0;   ///< sub-steps until the next check
  bool deep = false;   ///< see Collisions
};

/// In an increment of the time dt (s), at the velocity gradient `rate` of the cell (1/s, cell frame); the next check is
/// after `interval` sub-steps at the latest. Throws IncrementFailed where a given step is unstable.
TimeStep time_step(State& state, const Matrix3& rate, long interval, double dt);

}  // namespace rvelab
