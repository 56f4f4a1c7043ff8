// The kinds of slip, dashpot and local damping there are. Names only: step kernels include this, and nothing of
// the standard library.
#pragma once

namespace rvelab {

/// Where the slip of a contact is measured, and where its force acts (solver/kernels/pairs.hpp).
enum class Slip { consistent, full_radius, full_radius_ratcheting };

/// Radius of ellipses in Hertz's law: sqrt(a b), or that of their curvature at the contact (hertz_curvature.hpp).
enum class HertzRadius { equivalent, curvature };

/// Contact dashpot (damping.hpp).
enum class Dashpot { none, coefficient, restitution, viscoelastic, tsuji };

/// Form of Cundall's local damping on the fluctuation velocities.
enum class LocalDampingForm { vector, component };

}  // namespace rvelab
