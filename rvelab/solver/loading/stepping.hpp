// Sub-steps: the cell goes linearly from one lattice to the next while the grains follow. Everything that loads a
// specimen is made of calls of `advance`.
#pragma once

#include "rvelab/solver/assembly/assembly.hpp"

namespace rvelab {

enum class Loading { quasi_static, physical };

/// What one call of advance is to do. The increment is F_c = R U in the cell frame (split_increment).
struct Advance {
  FrameSplit increment;
  long steps = 1;
  double step = 1;  ///< s; 1 at dt = 0
  Loading loading = Loading::quasi_static;
  bool follow_collisions = false;  ///< dt > 0: a new list may show collisions that need finer sub-steps; made if so
  long look_every = 0;             ///< > 0: overlaps are looked at every so many sub-steps, not at the end alone
};

/// What was done: with finer sub-steps there are more of them.
struct Advanced {
  long steps = 0;
  double step = 1;  ///< of the last sub-step
};

/// Sub-steps between looks at the overlaps while one may come near its limit: of the 100 of a collision every fourth
/// finds the largest overlap to within 1 %.
constexpr long deep_look = 4;

/// Makes the sub-steps of one Advance: cell, grains, contacts, list, ledger. Afterwards the force rows belong to the
/// new positions and the frame has turned by R. Throws IncrementFailed (cell too thin, overlap beyond the limit).
Advanced advance(const Fixture& fixture, Assembly& assembly, const Advance& what);

/// Sets the units of the stored velocities for a kind of loading, and the physical masses; those of quasi-static
/// loading are the caller's to scale. Velocities end where the kind of loading changes.
void begin_loading(const Fixture& fixture, Assembly& assembly, Loading loading);

/// scale_inertia with the change of kinetic energy booked.
struct RowSums;
void rescale_inertia(const Fixture& fixture, const RowSums& sums, Assembly& assembly);

/// Of the fluctuations with the masses in use, in units of the force law's energy (J, also at dt = 0).
double kinetic_energy(const Fixture& fixture, const Assembly& assembly);

/// Sets all velocities to zero; books their energy where the ledger is kept.
void stop_grains(const Fixture& fixture, Assembly& assembly);

/// Reynolds stress times volume, -sum m v' v', cell frame, with the masses in use.
Matrix3 kinetic_moment(const Fixture& fixture, const Assembly& assembly);

/// Rotation vector (rad) of a proper rotation matrix, with square roots only.
Vector3 rotation_vector(const Matrix3& rotation);

}  // namespace rvelab
