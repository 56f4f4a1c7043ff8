// One pass of a kernel over all pairs or all grains of an assembly: piece by piece, the pieces of a large one shared
// among a team of threads. Pieces depend on nothing but their number, and their sums are added in order, so that the
// result has the same bits on any team and on none.
#pragma once

#include "rvelab/solver/kernels/configuration.hpp"
#include "rvelab/threads/workers.hpp"

namespace rvelab {

/// `team` may be null.
void sweep_pairs(PairKernel kernel, const StepConstants& constants, const PairArrays& pairs, const double* grain_rows,
                 long padded_pairs, Workers* team);
void sweep_grains(GrainKernel kernel, const StepConstants& constants, const GrainArrays& grains,
                  const PairArrays& pairs, long padded_grains, Workers* team, StepSums& sums);

}  // namespace rvelab
