#include "rvelab/interaction/bridge_of_pair.hpp"

#include <algorithm>
#include <cmath>

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

void CapillaryBridge::prepare(const Water& water, const GrainPair& pair, double* columns) {
  using B = CapillaryBridge;
  const double there = pair.gap < 0 ? 1 : columns[B::present];
  std::fill(columns, columns + interaction_columns<B>(), 0.0);
  columns[B::present] = there;
  const double theta = angle_of(water), ri = pair.radius_i, rj = pair.radius_j, thickness = pair.thickness;
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

const char* CapillaryBridge::settings_for(double saturation, double pore_volume, const GrainPair* pairs, long count,
                                          Water& water) {
  const double wanted = saturation * pore_volume;
  if (count == 0) return "no grains touch, and none has a bridge";
  water.suction = water.volume_ratio = 0;
  if (!(pairs[0].thickness > 0)) {
    double cubes = 0;
    for (long k = 0; k < count; ++k) cubes += volume_of({0, 0, 0, 1}, pairs[k].radius_i, pairs[k].radius_j);
    water.volume_ratio = wanted / cubes;
    return water.volume_ratio <= bridge_range::largest_volume ? nullptr : "bridges would be larger than a tenth of r^3";
  }
  const auto held = [&](double suction) {
    Water at = water;
    at.suction = suction;
    return target_of(at, 1, pairs, count);
  };
  double low = 1e-3 * water.surface_tension / pairs[0].radius_i, high = 1e7 * low;  // volume falls with suction
  if (held(low) < wanted) return "arcs would be a thousand times as wide as grains";
  if (held(high) > wanted) return "it is too little to bridge these grains";
  for (int step = 0; step < 100; ++step) {
    const double middle = std::sqrt(low * high);
    (held(middle) > wanted ? low : high) = middle;
  }
  water.suction = high;
  return nullptr;
}

double CapillaryBridge::target_of(const Water& water, double pore_volume, const GrainPair* pairs, long count) {
  double sum = 0;
  for (long k = 0; k < count; ++k) sum += content_of_bridge(water, pairs[k]).volume;
  return sum / pore_volume;
}

BridgeContent content_of_bridge(const Water& water, const GrainPair& pair) {
  const double theta = angle_of(water), ri = pair.radius_i, rj = pair.radius_j, s = std::max(pair.gap, 0.0);
  if (pair.thickness > 0) {
    const BridgeState at = planar_suction_bridge({ri, rj, theta, water.surface_tension}, water.suction, s);
    return {at.volume * pair.thickness, at.suction};
  }
  const BridgeState at = water.suction > 0
                             ? suction_bridge(water.suction, ri, rj, theta, water.surface_tension).at(s)
                             : volume_bridge(volume_of(water, ri, rj), ri, rj, theta, water.surface_tension).at(s);
  return {at.volume, at.suction};
}

}  // namespace rvelab
