// Water between the grains of a specimen: how each bridge is made. No standard library.
#pragma once

namespace rvelab {

/// Either suction or volume is above 0.
struct Water {
  double surface_tension = 0.0728;  ///< gamma, N/m; water at 20 degrees
  double contact_angle_deg = 0;     ///< 0 to 45
  double suction = 0;               ///< Pa, > 0: of all bridges, in exchange with a reservoir
  double volume_ratio = 0;          ///< > 0: volume of each bridge over the cube of its smaller radius; spheres
};

}  // namespace rvelab
