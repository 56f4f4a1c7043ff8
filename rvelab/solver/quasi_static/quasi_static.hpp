// Quasi-static loading by a strain increment: choose the sub-steps, advance, check, estimate the error. The
// strain of a sub-step follows the unbalanced ratio; what ratio an increment may have, and how many sub-steps a start
// or a turn takes, follows from its tolerance.
#pragma once

#include "rvelab/solver/loading/mixed_target.hpp"
#include "rvelab/solver/state/state.hpp"

namespace rvelab {

/// Whether an increment begins where trials of the same committed state did, and leaves them where it did
/// (state/trial_cache.hpp).
enum class TrialCaching { off, on };
/// Applies the increment together with any deferred strain. Throws IncrementFailed.
Report load_quasi_static(State& state, FrameSplit increment, TrialCaching caching);
/// A rotation: grains and stress turn with the frame of the cell.
Report load_rotation(State& state, const FrameSplit& increment, const Matrix3& displacement_gradient);
/// Applies the deferred strain; the number of sub-steps.
long apply_deferred(State& state);
/// A mixed target (stress_control.cpp); `gradient` is what was found. Throws as Rve::apply says.
Report follow_target_quasi_static(State& state, const MixedTarget& target, Matrix3& gradient);
/// Rve::relax (relaxation.cpp).
Report relax(State& state, double unbalanced, long max_steps);

/// Throws IncrementFailed if so many sub-steps are more than solver.max_substeps.
void expect_substeps(const State& state, long needed);

}  // namespace rvelab
