// Sub-steps: the cell goes linearly from one lattice to the next while the grains follow. Everything that loads a
// specimen is made of calls of `make_substeps`.
#pragma once

#include "rvelab/solver/loading/velocities.hpp"

namespace rvelab {

/// What one call of make_substeps is to do. The increment is F_c = R U in the cell frame (split_increment).
struct Advance {
  FrameSplit increment;
  long steps = 1;
  double step = 1;  ///< s; quasi-static: over that for which masses are scaled
  Loading loading = Loading::quasi_static;
  bool follow_collisions = false;  ///< at a rate: a new list may show collisions that need finer sub-steps; made if so
  long check_every = 0;            ///< > 0: overlaps are checked every so many sub-steps, not at the end alone
  double damping = 1;              ///< quasi-static: over Damping::local_quasi_static
};

/// What was done: with finer sub-steps there are more of them.
struct Advanced {
  long steps = 0;
  double step = 1;  ///< of the last sub-step
};

/// Sub-steps between checks of the overlaps while one may come near its limit: of the 100 of a collision every fourth
/// finds the largest overlap to within 1 %.
constexpr long deep_check = 4;

/// Makes the sub-steps of one Advance: cell, grains, contacts, list, energy balance. Afterwards the force rows belong
/// to the new positions and the frame has turned by R. Throws IncrementFailed (cell too thin, overlap beyond the
/// limit).
Advanced make_substeps(const Model& model, Assembly& assembly, const Advance& what);

}  // namespace rvelab
