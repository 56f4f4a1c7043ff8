// A bridge of liquid between two discs, in the plane, per unit of thickness: exact, since its two menisci are arcs.
//
// S = p_air - p_water > 0, gamma the surface tension, theta the contact angle, rho = gamma/S. The centre of either arc
// is D_i from the centre of disc i and y above the line of centres, with L the distance of the centres:
//   D_i^2 = R_i^2 + rho^2 + 2 R_i rho cos(theta),   x_1 = (L^2 + D_1^2 - D_2^2)/(2 L),   y^2 = D_1^2 - x_1^2
//   pull = 2 gamma + 2 S (y - rho) = 2 S y,   filling angle d_i = atan2(y, x_i) - atan2(rho sin(theta), R_i + rho
//   cos(theta)) V = L y - (R_1 + R_2) rho sin(theta) - R_1^2 d_1 - R_2^2 d_2 - rho^2 psi,   psi = pi - 2 theta - d_1 -
//   d_2 surface energy = 2 gamma rho psi - 2 gamma cos(theta) (R_1 d_1 + R_2 d_2)
// It ruptures where the menisci touch, y = rho: at the gap sqrt(D_1^2 - rho^2) + sqrt(D_2^2 - rho^2) - R_1 - R_2 at
// given suction. There the pull is still 2 gamma. At a given volume rho follows from V by Newton's method; with
// Maxwell's relation d(pull)/dS at a gap = dV/d(gap) at a suction.
//
// Signs, energies and overlapping grains as in capillary.hpp. Volumes up to where the arcs become straight (psi = 0).
#pragma once

#include <cmath>

#include "rvelab/interaction/capillary.hpp"

namespace rvelab::interaction {

/// Two discs and their liquid: m, radians, N/m.
struct PlanarPair {
  double r1 = 0, r2 = 0, theta = 0, tension = 0;
};

namespace planar_detail {

/// A bridge of a given arc, and its derivatives. Volumes in m^2, energies in J/m.
struct Arc {
  double height = 0, pull = 0, volume = 0, psi = 0, surface_energy = 0;
  double pull_over_gap = 0;  ///< at given suction
  double pull_over_rho = 0, volume_over_rho = 0;
  bool bridges = false;
};

inline Arc arc_at(const PlanarPair& p, double gap, double rho) {
  Arc out;
  const double c = std::cos(p.theta), s = std::sin(p.theta);
  const double L = p.r1 + p.r2 + gap;
  const double square1 = p.r1 * p.r1 + rho * rho + 2 * p.r1 * rho * c;
  const double square2 = p.r2 * p.r2 + rho * rho + 2 * p.r2 * rho * c;
  const double x1 = (L * L + square1 - square2) / (2 * L), x2 = L - x1;
  const double under = square1 - x1 * x1;
  if (!(under > 0)) return out;
  const double y = std::sqrt(under), S = p.tension / rho;
  const double d1 = std::atan2(y, x1) - std::atan2(rho * s, p.r1 + rho * c);
  const double d2 = std::atan2(y, x2) - std::atan2(rho * s, p.r2 + rho * c);
  out.height = y;
  out.psi = bridge_detail::pi - 2 * p.theta - d1 - d2;
  out.bridges = y >= rho && out.psi > 0;
  out.pull = 2 * S * y;
  out.volume = L * y - (p.r1 + p.r2) * rho * s - p.r1 * p.r1 * d1 - p.r2 * p.r2 * d2 - rho * rho * out.psi;
  out.surface_energy = 2 * p.tension * (rho * out.psi - c * (p.r1 * d1 + p.r2 * d2));
  out.pull_over_gap = 2 * S * (-x1 * x2 / (L * y));
  const double x1_rho = (p.r1 - p.r2) * c / L, y_rho = (rho + p.r1 * c - x1 * x1_rho) / y;
  out.pull_over_rho = 2 * S * (y_rho - y / rho);
  const double d1_rho = (x1 * y_rho - y * x1_rho) / square1 - p.r1 * s / square1;
  const double d2_rho = (x2 * y_rho + y * x1_rho) / square2 - p.r2 * s / square2;
  out.volume_over_rho = L * y_rho - (p.r1 + p.r2) * s - p.r1 * p.r1 * d1_rho - p.r2 * p.r2 * d2_rho -
                        2 * rho * out.psi + rho * rho * (d1_rho + d2_rho);
  return out;
}

/// Gap at which the menisci of this arc touch.
inline double rupture_gap(const PlanarPair& p, double rho) {
  const double c = std::cos(p.theta);
  return std::sqrt(p.r1 * (p.r1 + 2 * rho * c)) + std::sqrt(p.r2 * (p.r2 + 2 * rho * c)) - p.r1 - p.r2;
}

inline BridgeState state(const Arc& arc, const PlanarPair& p, double rho, double gap) {
  BridgeState out;
  out.force = -arc.pull;
  if (gap >= 0) out.stiffness = arc.pull_over_gap;
  out.suction = p.tension / rho;
  out.volume = arc.volume;
  return out;
}

}  // namespace planar_detail

/// Largest volume of discs at a gap, m^2: that of straight menisci, or of arcs of 1e4 (R_1 + R_2), which are nearly so.
inline double planar_largest_volume(const PlanarPair& p, double gap) {
  const auto bent = [&](double rho) {  // psi falls as rho grows; an arc too small to reach both discs counts as bent
    const planar_detail::Arc arc = planar_detail::arc_at(p, gap, rho);
    return !(arc.height > 0) || arc.psi > 0;
  };
  double low = 0, high = 1e4 * (p.r1 + p.r2);
  if (bent(high)) return planar_detail::arc_at(p, gap, high).volume;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (bent(middle) ? low : high) = middle;
  }
  return planar_detail::arc_at(p, gap, low).volume;
}

inline double planar_rupture_gap_of_suction(const PlanarPair& p, double suction) {
  return planar_detail::rupture_gap(p, p.tension / suction);
}
/// The arc at which a volume ruptures; the volume of touching menisci grows with the arc.
inline double planar_rupture_arc(const PlanarPair& p, double volume) {
  const double start = std::sqrt(volume);
  double low = 0, high = start;
  for (int k = 0; k < 60; ++k) {
    if (planar_detail::arc_at(p, planar_detail::rupture_gap(p, high), high).volume >= volume) break;
    low = high;
    high *= 2;
  }
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    const double held = planar_detail::arc_at(p, planar_detail::rupture_gap(p, middle), middle).volume;
    (held < volume ? low : high) = middle;
  }
  return 0.5 * (low + high);
}
inline double planar_rupture_gap_of_volume(const PlanarPair& p, double volume) {
  return planar_detail::rupture_gap(p, planar_rupture_arc(p, volume));
}

/// A bridge of given suction, S > 0, Pa.
inline BridgeState planar_suction_bridge(const PlanarPair& p, double suction, double gap) {
  const double rho = p.tension / suction, rupture = planar_detail::rupture_gap(p, rho);
  if (gap > rupture) return {};
  const double s = gap > 0 ? gap : 0;
  const planar_detail::Arc arc = planar_detail::arc_at(p, s, rho), last = planar_detail::arc_at(p, rupture, rho);
  BridgeState out = planar_detail::state(arc, p, rho, gap);
  out.energy = (arc.surface_energy + suction * arc.volume) - (last.surface_energy + suction * last.volume) +
               out.force * (s - gap);
  return out;
}

/// A bridge of given volume, m^2; `rupture_arc` = planar_rupture_arc(p, volume), kept for the pair.
inline BridgeState planar_volume_bridge(const PlanarPair& p, double volume, double rupture_arc, double gap) {
  const double rupture = planar_detail::rupture_gap(p, rupture_arc);
  if (gap > rupture) return {};
  const double s = gap > 0 ? gap : 0;
  // Between the arc whose menisci touch at this gap and that of rupture, which is the largest: safeguarded Newton.
  double low = 0, high = rupture_arc, rho = rupture_arc;
  planar_detail::Arc arc = planar_detail::arc_at(p, s, rho);
  for (int step = 0; step < 60; ++step) {
    const bool none = !(arc.height > 0);
    (none || arc.volume < volume ? low : high) = rho;
    double next = none ? 0 : rho - (arc.volume - volume) / arc.volume_over_rho;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::fabs(next - rho) <= 1e-15 * rho) break;
    rho = next;
    arc = planar_detail::arc_at(p, s, rho);
  }
  const planar_detail::Arc last = planar_detail::arc_at(p, rupture, rupture_arc);
  BridgeState out = planar_detail::state(arc, p, rho, gap);
  if (gap >= 0) {  // at given volume: the arc follows
    const double volume_over_gap = -arc.pull_over_rho * rho * rho / p.tension;
    out.stiffness = arc.pull_over_gap - arc.pull_over_rho * volume_over_gap / arc.volume_over_rho;
  }
  out.energy = arc.surface_energy - last.surface_energy + out.force * (s - gap);
  return out;
}

}  // namespace rvelab::interaction
