// What a bridge between two grains is, from their radii and the water of the specimen: the columns of CapillaryBridge,
// and the volume and suction that it has at a gap.
#pragma once

#include "rvelab/interaction/water.hpp"

namespace rvelab {

/// Radii in m; `thickness` in m of discs, 0 of spheres. Not present yet.
void make_bridge(const Water& water, double ri, double rj, double thickness, double* columns);

/// Of a bridge at a gap, m; below 0 as at 0. m^3 and Pa; both 0 beyond rupture.
struct BridgeContent {
  double volume = 0, suction = 0;
};
BridgeContent content_of_bridge(const Water& water, double ri, double rj, double thickness, double gap);

}  // namespace rvelab
