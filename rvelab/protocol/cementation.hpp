// Cement between grains: which pairs get a bond, and of what strength (rvelab/interaction: parallel_bond.hpp,
// surface_bond.hpp, contact_bond.hpp, softening_bond.hpp).
#pragma once

#include <cstdint>

#include "rvelab/solver/rve.hpp"

namespace rvelab::protocol {

enum class BondModel { parallel, surface, contact, softening };

/// Cement as a stage gives it. Stiffness of a bond between grains of radii r_i, r_j: kn = E/(r_i + r_j), ks =
/// shear_ratio kn (Potyondy and Cundall 2004, eq. 16).
struct Cementation {
  BondModel model = BondModel::parallel;
  double gap = 0;            ///< largest gap of a pair that is cemented, over the radius of its smaller grain
  double share = 1;          ///< of these pairs, drawn by seed
  std::uint64_t seed = 0;    ///< and of their strengths
  double radius = 1;         ///< of a bond, over that of the smaller grain
  double young_modulus = 0;  ///< Pa
  double shear_ratio = 0.4;  ///< ks/kn
  double tensile_strength = 0, cohesion = 0;  ///< Pa; a surface has no cohesion but friction times tensile strength
  double friction_angle_deg = 0;
  double fracture_energy = 0;   ///< J/m^2, of bonds that soften
  double moment_factor = 1;     ///< of the moments in the stress at the rim
  double strength_scatter = 0;  ///< standard deviation of both strengths over their mean, between bonds: Weibull's
                                ///< distribution; 0: none
};

/// Bonds of the state as it is, without force, beside those that it has: a pair that is bonded keeps its bond, one
/// whose bond is broken gets a new one. The draw hangs on seed, ids and image alone.
Interactions cemented(const Rve& rve, const Cementation& cement);

/// Modulus m of the Weibull distribution whose standard deviation is this part of its mean, sqrt(Gamma(1 + 2/m)/Gamma(1
/// + 1/m)^2 - 1); 0.001 to 2.
double weibull_modulus(double scatter);

/// Factor on the strength of a bond of Weibull's distribution with mean 1; `draw` in [0, 1).
double weibull_factor(double modulus, double draw);

}  // namespace rvelab::protocol
