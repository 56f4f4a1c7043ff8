// A bridge of liquid between two discs, in the plane, per unit of thickness: exact, since its two menisci are arcs.
//
// S = p_air - p_water > 0, gamma the surface tension, theta the contact angle, rho = gamma/S. The centre of either arc
// is D_i from the centre of disc i and y above the line of centres, with L the distance of the centres:
//   D_i^2 = R_i^2 + rho^2 + 2 R_i rho cos(theta),   x_1 = (L^2 + D_1^2 - D_2^2)/(2 L),   y^2 = D_1^2 - x_1^2
//   pull = 2 gamma + 2 S (y - rho) = 2 S y,   filling angle d_i = atan2(y, x_i) - atan2(rho sin(theta), R_i + rho
//   cos(theta)) V = L y - (R_1 + R_2) rho sin(theta) - R_1^2 d_1 - R_2^2 d_2 - rho^2 psi,   psi = pi - 2 theta - d_1 -
//   d_2 surface energy = 2 gamma rho psi - 2 gamma cos(theta) (R_1 d_1 + R_2 d_2)
// It ruptures where the menisci touch, y = rho: at the gap sqrt(D_1^2 - rho^2) + sqrt(D_2^2 - rho^2) - R_1 - R_2. There
// the pull is still 2 gamma. Maxwell's relation: d(pull)/dS at a gap = dV/d(gap) at a suction.
//
// Signs, energies and overlapping grains as in capillary.hpp.
#pragma once

#include <cmath>

#include "rvelab/interaction/capillary.hpp"

namespace rvelab::interaction {

/// Two discs and their liquid: m, radians, N/m.
struct PlanarPair {
  double r1 = 0, r2 = 0, theta = 0, tension = 0;
};

namespace planar_detail {

/// A bridge of a given arc. Volume in m^2, energy in J/m; pull_over_gap at given suction.
struct Arc {
  double pull = 0, volume = 0, surface_energy = 0, pull_over_gap = 0;
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
  const double psi = bridge_detail::pi - 2 * p.theta - d1 - d2;
  out.pull = 2 * S * y;
  out.volume = L * y - (p.r1 + p.r2) * rho * s - p.r1 * p.r1 * d1 - p.r2 * p.r2 * d2 - rho * rho * psi;
  out.surface_energy = 2 * p.tension * (rho * psi - c * (p.r1 * d1 + p.r2 * d2));
  out.pull_over_gap = 2 * S * (-x1 * x2 / (L * y));
  return out;
}

/// Gap at which the menisci of this arc touch.
inline double rupture_gap(const PlanarPair& p, double rho) {
  const double c = std::cos(p.theta);
  return std::sqrt(p.r1 * (p.r1 + 2 * rho * c)) + std::sqrt(p.r2 * (p.r2 + 2 * rho * c)) - p.r1 - p.r2;
}

}  // namespace planar_detail

inline double planar_rupture_gap_of_suction(const PlanarPair& p, double suction) {
  return planar_detail::rupture_gap(p, p.tension / suction);
}

/// A bridge of given suction, S > 0, Pa.
inline BridgeState planar_suction_bridge(const PlanarPair& p, double suction, double gap) {
  const double rho = p.tension / suction, rupture = planar_detail::rupture_gap(p, rho);
  if (gap > rupture) return {};
  const double s = gap > 0 ? gap : 0;
  const planar_detail::Arc arc = planar_detail::arc_at(p, s, rho), last = planar_detail::arc_at(p, rupture, rho);
  BridgeState out;
  out.force = -arc.pull;
  if (gap >= 0) out.stiffness = arc.pull_over_gap;
  out.suction = p.tension / rho;
  out.volume = arc.volume;
  out.energy = (arc.surface_energy + suction * arc.volume) - (last.surface_energy + suction * last.volume) +
               out.force * (s - gap);
  return out;
}

}  // namespace rvelab::interaction
