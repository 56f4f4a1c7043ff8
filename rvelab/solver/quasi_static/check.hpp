// The equilibrium check of quasi-static loading. Every 50 sub-steps, over as many calls as make them, an interval ends:
// masses are scaled again and the stiffness ratio of the interval is measured.
#pragma once

#include "rvelab/solver/state/state.hpp"

namespace rvelab {

class EquilibriumCheck {
 public:
  /// Of a state that prepare() was called for, or that is a copy of such a one (the trial cache): not_yet_checked is
  /// then that of the one before.
  explicit EquilibriumCheck(State& state, bool not_yet_checked = false)
      : state_(state), not_yet_checked_(not_yet_checked) {}

  /// Sets quasi-static loading: velocities of another kind end, masses are scaled where none are.
  void prepare();

  /// Measures the unbalanced ratio. Throws as State::checked_balance.
  const OutOfBalance& check();
  bool not_yet_checked() const { return not_yet_checked_; }
  /// Whether so many sub-steps are made since masses were scaled that a check is due.
  bool is_due() const;
  /// Whether the end of an increment of so many sub-steps and this strain is checked. If not, it is judged by what is
  /// known already.
  bool is_due_at_end(long substeps, double strain) const;

 private:
  void begin_interval();
  void renew_interval();

  State& state_;
  /// Grains, contacts or parameters are others than those that masses were scaled for, and the state may be no
  /// equilibrium any more: friction lowered shows in the forces after a sub-step only.
  bool not_yet_checked_;
};

}  // namespace rvelab
