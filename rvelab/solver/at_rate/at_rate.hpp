// Loading at a rate: physical masses, sub-steps of the critical step and of the collisions ahead.
#pragma once

#include "rvelab/solver/loading/mixed_target.hpp"
#include "rvelab/solver/state/state.hpp"

namespace rvelab {

/// An increment over the time dt, s. Throws IncrementFailed.
Report load_at_rate(State& state, const FrameSplit& increment, double dt);

/// A mixed target over the time dt, no more: `gradient` is what was found. A stress that is missed is no error:
/// Report::target_held says so.
Report follow_target_at_rate(State& state, const MixedTarget& target, double dt, Matrix3& gradient);

/// The sub-step: the critical step of the contacts, and the collisions ahead.
struct TimeStep {
  double longest = 0;  ///< s
  long interval = 0;   ///< sub-steps until the next check
  bool deep = false;   ///< see Collisions
};

/// In an increment of the time dt (s), at the velocity gradient `rate` of the cell (1/s, cell frame); the next check is
/// after `interval` sub-steps at the latest. Throws IncrementFailed where a given step is unstable, and as
/// State::checked_balance.
TimeStep time_step(State& state, const Matrix3& rate, long interval, double dt);

}  // namespace rvelab
