// Parallel bonds: beams (beam.hpp) that break by the stress at their rim (Potyondy and Cundall 2004; the factor on
// moments: Potyondy 2011, ISRM 12th congress, 1055-1060).
//
//   tension at the rim  -f_n/A + beta |M_b| R/I > tensile strength: broken in tension
//   shear at the rim    |f_s|/A + beta |M_t| R/J > cohesion + tan(phi) f_n/A: broken in shear
#pragma once

#include "rvelab/interaction/beam.hpp"

namespace rvelab {

struct RimStress {
  static constexpr const char* name = "bonds";
  static constexpr InteractionField strengths[] = {{"tensile_strength_Pa", "Pa", number_from_zero},
                                                   {"cohesion_Pa", "Pa", number_from_zero},
                                                   {"friction", "1", number_from_zero},  // tan(phi)
                                                   {"moment_factor", "1", {0, 1}}};      // beta
  enum Strength { tensile, cohesion, friction, moment_factor };

  /// Both criteria times A R, squared, so that no root and no division is left.
  template <class V>
  static inline __attribute__((always_inline)) V broken_by(const V* strength, const BeamLoad<V>& load) {
    const V zero = V{}, one = zero + 1.0, two = zero + 2.0;
    const V tension = (strength[tensile] * load.area + load.normal) * load.radius;
    const V bending = load.rim * strength[moment_factor];
    const V limit = strength[cohesion] * load.area + strength[friction] * load.normal;
    const V shear = ((limit > zero) ? limit : zero) * load.radius - 2.0 * (strength[moment_factor] * load.twisting);
    const auto in_tension = (tension < zero) | ((bending * bending) * load.bending_squared > tension * tension);
    const auto in_shear = (shear < zero) | ((load.radius * load.radius) * load.shear_squared > shear * shear);
    return in_tension ? one : (in_shear ? two : zero);
  }
};

struct ParallelBond : Beam<RimStress> {
  enum Strength { tensile_strength = strength, cohesion, friction, moment_factor };  ///< columns
};

}  // namespace rvelab
