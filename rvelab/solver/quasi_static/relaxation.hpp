// Relaxation before a turn of the path: sub-steps of a cell that keeps its shape.
#pragma once

#include "rvelab/solver/quasi_static/check.hpp"

namespace rvelab {

struct Relaxed {
  long steps = 0;
  double creep = 0;  ///< Pa, what a longer one would still bring, about
};

/// What the relaxation before any increment depends on; of a state that has begun quasi-static loading to a tolerance.
CachedRelaxation inputs_of_relaxation(State& state);
/// Before an increment of this strain that reverses, or goes on where the path was coarser: a state that lags by more
/// than its tolerance relaxes. Its lag would stay, since unloading locks the contacts that would have crept: 1 to 12 %
/// of such increments were within the tolerance without. A path to a tolerance lags by no more than that; one under
/// stress control, or to a given ratio, may by a hundred times as much. `relaxation` is filled in.
Relaxed relax_before(State& state, EquilibriumCheck& check, double strain, bool reverses, CachedRelaxation& relaxation);
/// Whether an increment of this strain would relax as `made` was, from the same state.
bool relaxes_alike(const SolverOptions& options, const CachedRelaxation& made, double strain, bool reverses);
/// Sub-steps that it took, those of copies too.
long substeps_of(const CachedRelaxation& made);
/// What relax_before returns, of a state that relaxed so. Measures creep_of_rolling unless it is known.
Relaxed relaxed_by(State& state, CachedRelaxation& made);

}  // namespace rvelab
