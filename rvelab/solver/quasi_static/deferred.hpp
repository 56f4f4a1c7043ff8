// Deferred strain: in quasi-static loading an increment that is a small part of a sub-step is left to the next one, and
// its stress follows from the slope of the stress over the increment before. A path in pieces of 1e-7 then takes 1.3
// times the sub-steps of one in pieces of 1e-5.
#pragma once

#include <optional>

#include "rvelab/solver/state/state.hpp"

namespace rvelab {

/// Change of the contact stress by a stretch of the cell that the grains have not made, cell frame, Pa, and what it may
/// err by.
struct Extrapolated {
  Matrix3 stress = Matrix3::Zero();
  double error = 0;
};
Extrapolated extrapolated(const State& state, const Matrix3& stretch);

/// All that is left to the next sub-step with an increment, whose stress can be extrapolated within its tolerance.
struct Deferral {
  Matrix3 stretch;
  Extrapolated change;
  double elastic_change;  ///< Pa, of the path
};
std::optional<Deferral> deferral_of(State& state, const FrameSplit& increment);
/// Leaves it. Moves no grain; cannot fail.
Report defer(State& state, const FrameSplit& increment, const Deferral& deferral);
/// Whether an increment can be made in one with what is deferred.
bool is_along_deferred(const State& state, const FrameSplit& increment);

/// Notes the slope of an increment that is made, from the stress before it; none where the cell frame turned meanwhile.
void note_slope(State& state, const Matrix3& stretch, const Matrix3& stress_before, bool same_frame);

}  // namespace rvelab
