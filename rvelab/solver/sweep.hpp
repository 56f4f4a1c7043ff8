// One pass of a kernel over all pairs or all grains of an assembly: piece by piece, the pieces of a large one shared
// among a team of threads. Pieces depend on nothing but their number, and their sums are added in order, so that the
// result has the same bits on any team and on none.
#pragma once

#include <vector>

#include "rvelab/solver/scene.hpp"
#include "rvelab/solver/workers.hpp"

namespace rvelab {

/// `team` may be null.
void sweep_pairs(PairKernel kernel, const StepConstants& constants, const PairArrays& pairs, const double* grain_rows,
                 long padded_pairs, Workers* team);
/// The same in the order of the pairs and on one thread, with what is dissipated: a sum that must not depend on where the
/// pairs lie. Every pair is computed.
Dissipation sweep_pairs_with_losses(PairKernel kernel, const StepConstants& constants, PairArrays pairs,
                                    const double* grain_rows, const std::vector<std::int32_t>& order);
void sweep_grains(GrainKernel kernel, const StepConstants& constants, const GrainArrays& grains,
                  const PairArrays& pairs, long padded_grains, Workers* team, StepSums& sums);

}  // namespace rvelab
