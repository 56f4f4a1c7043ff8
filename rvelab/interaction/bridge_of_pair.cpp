#include "rvelab/interaction/bridge_of_pair.hpp"

#include <algorithm>

#include "rvelab/interaction/bridge.hpp"
#include "rvelab/interaction/capillary.hpp"
#include "rvelab/interaction/planar_bridge.hpp"

namespace rvelab {

namespace {

using namespace interaction;

double angle_of(const Water& water) { return water.contact_angle_deg * bridge_detail::pi / 180; }

/// Of a bridge of spheres.
double volume_of(const Water& water, double ri, double rj) {
  const double r = std::min(ri, rj);
  return water.volume_ratio * r * r * r;
}

void set(const BridgeSeries& series, double* columns) {
  for (int k = 0; k < CapillaryBridge::terms; ++k)
    columns[CapillaryBridge::pull + k] = k < series.count ? series.coefficient[k] : 0;
}

}  // namespace

void make_bridge(const Water& water, double ri, double rj, double thickness, double* columns) {
  using B = CapillaryBridge;
  std::fill(columns, columns + interaction_columns<B>(), 0.0);
  const double theta = angle_of(water);
  if (thickness > 0) {
    const double rho = water.surface_tension / water.suction, along = 2 * rho * cosine(theta);
    columns[B::rupture_gap] = planar_rupture_gap_of_suction({ri, rj, theta, water.surface_tension}, water.suction);
    columns[B::scale] = 2 * water.suction * thickness;
    columns[B::first_square] = ri * ri + rho * rho + along * ri;
    columns[B::second_square] = rj * rj + rho * rho + along * rj;
    columns[B::radii] = ri + rj;
    return;
  }
  if (water.suction > 0) {
    const SuctionBridge bridge = suction_bridge(water.suction, ri, rj, theta, water.surface_tension);
    columns[B::rupture_gap] = bridge.rupture_gap;
    columns[B::scale] = bridge.scale;
    set(bridge.pull, columns);
    return;
  }
  const VolumeBridge bridge = volume_bridge(volume_of(water, ri, rj), ri, rj, theta, water.surface_tension);
  columns[B::rupture_gap] = bridge.rupture_gap;
  columns[B::scale] = bridge.scale;
  columns[B::steepness] = 1;
  columns[B::square] = bridge.square;
  set(bridge.pull, columns);
}

BridgeContent content_of_bridge(const Water& water, double ri, double rj, double thickness, double gap) {
  const double theta = angle_of(water), s = std::max(gap, 0.0);
  if (thickness > 0) {
    const BridgeState at = planar_suction_bridge({ri, rj, theta, water.surface_tension}, water.suction, s);
    return {at.volume * thickness, at.suction};
  }
  const BridgeState at = water.suction > 0
                             ? suction_bridge(water.suction, ri, rj, theta, water.surface_tension).at(s)
                             : volume_bridge(volume_of(water, ri, rj), ri, rj, theta, water.surface_tension).at(s);
  return {at.volume, at.suction};
}

}  // namespace rvelab
