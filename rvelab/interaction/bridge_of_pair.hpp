// Volume and suction of a bridge between two grains at a gap.
#pragma once

#include "rvelab/interaction/water.hpp"

namespace rvelab {

/// Below a gap of 0 as there. m^3 and Pa; both 0 beyond rupture.
struct BridgeContent {
  double volume = 0, suction = 0;
};
BridgeContent content_of_bridge(const Water& water, const GrainPair& pair);

}  // namespace rvelab
