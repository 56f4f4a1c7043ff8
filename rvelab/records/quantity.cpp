#include "rvelab/records/quantity.hpp"

#include <algorithm>

#include "rvelab/interaction/bridge_of_pair.hpp"

namespace rvelab::records {

std::size_t MeasuredState::acting(Family family) const {
  return std::size_t(std::count_if(network.interactions.begin(), network.interactions.end(),
                                   [=](const InteractionState& other) { return family_of(other.kind) == family; }));
}

double MeasuredState::water_volume() const {
  const std::vector<Water>& water =
      static_cast<const SettingsOf<CapillaryBridge>&>(rve.interaction_settings()).settings;
  GrainPair pair;
  pair.thickness = network.dimension() == 2 ? network.cell.lattice(2, 2) : 0;
  double sum = 0;
  for (const InteractionState& other : network.interactions) {
    if (family_of(other.kind) != Family::water) continue;
    pair.radius_i = network.grains[std::size_t(other.i)].radius;
    pair.radius_j = network.grains[std::size_t(other.j)].radius;
    pair.gap = -other.overlap;
    sum += content_of_bridge(water.front(), pair).volume;
  }
  return sum;
}

}  // namespace rvelab::records
