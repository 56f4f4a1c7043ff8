#include "rvelab/records/quantity.hpp"

#include <algorithm>

#include "rvelab/interaction/bridge_of_pair.hpp"

namespace rvelab::records {

std::size_t MeasuredState::bridges() const {
  return std::size_t(std::count_if(network.interactions.begin(), network.interactions.end(),
                                   [](const InteractionState& other) { return other.kind == bridges_kind; }));
}

double MeasuredState::water_volume() const {
  double sum = 0;
  for (const InteractionState& other : network.interactions)
    if (other.kind == bridges_kind)
      sum += content_of_bridge(*rve.water(), network.grains[std::size_t(other.i)].radius,
                               network.grains[std::size_t(other.j)].radius,
                               network.dimension() == 2 ? network.cell.lattice(2, 2) : 0, -other.overlap)
                 .volume;
  return sum;
}

}  // namespace rvelab::records
