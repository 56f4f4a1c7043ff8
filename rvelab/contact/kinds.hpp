// The kinds of law, slip, dashpot and local damping there are. Names only: step kernels include this, and nothing of
// the standard library.
#pragma once

namespace rvelab {

/// Normal and tangential law of all contacts of a specimen (design 6).
enum class Law {
  linear,         ///< kn = 2 Ei ri Ej rj/(Ei ri + Ej rj), kt the same with E nu (linear.hpp)
  linear_given,   ///< kn, kt in N/m as numbers (linear.hpp)
  hertz_mindlin,  ///< from E and Poisson's ratio (hertz.hpp)
  hertz_given     ///< k delta^1.5 with k in N/m^1.5, constant kt in N/m (hertz.hpp)
};

/// Where the slip of a contact is measured, and where its force acts (slip.hpp).
enum class Slip { consistent, full_radius, full_radius_ratcheting };

/// Contact dashpot (damping.hpp).
enum class Dashpot { none, coefficient, restitution, viscoelastic, tsuji };

/// Form of Cundall's local damping on the fluctuation velocities.
enum class LocalDampingForm { vector, component };

}  // namespace rvelab
