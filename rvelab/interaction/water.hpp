// Water between the grains of a specimen: what its bridges form from. No standard library.
#pragma once

#include "rvelab/interaction/law.hpp"

namespace rvelab {

/// Either suction or volume is above 0.
struct Water {
  double surface_tension = 0.0728;  ///< gamma, N/m; water at 20 degrees
  double contact_angle_deg = 0;     ///< 0 to 45
  double suction = 0;               ///< Pa, > 0: of all bridges, in exchange with a reservoir
  double volume_ratio = 0;          ///< > 0: volume of each bridge over the cube of its smaller radius; spheres
};

inline constexpr SettingsField<Water> water_fields[] = {
    {"surface_tension_N_m", &Water::surface_tension, "N/m", positive_number, "of water and air"},
    {"contact_angle_deg", &Water::contact_angle_deg, "degrees", {0, 45}, "of water on the grains"},
    {"suction_Pa", &Water::suction, "Pa", number_from_zero, "of all bridges, which exchange water with a reservoir",
     true},
    {"volume_ratio",
     &Water::volume_ratio,
     "1",
     {0, 0.1},
     "volume of each bridge over the cube of its smaller radius, between spheres",
     true},
};

}  // namespace rvelab
