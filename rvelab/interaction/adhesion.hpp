// Adhesion of elastic spheres: JKR (soft, sticky, small grains) and DMT (hard ones).
//
// JKR (Johnson, Kendall and Roberts 1971, Proc. R. Soc. A 324, 301): with the radius a of the area of contact
//   F = 4 E* a^3/(3 R*) - sqrt(8 pi w E* a^3),   delta = a^2/R* - sqrt(2 pi w a/E*)
// F is positive in compression, delta the overlap. In y = sqrt(a/a1), a1^3 = 2 pi w R*^2/E*, delta1 = a1^2/R*:
//   F = 4 pi w R* (2/3 y^6 - y^3),   delta = delta1 (y^4 - y),   U = 4 pi w R* delta1 (4/15 y^10 - 2/3 y^7 + y^4/4)
// U is the energy over that of grains apart. Surfaces meet at delta = 0, where F jumps from 0 to -4/3 pi w R*, and stay
// together down to y^3 = 1/4: there delta = -3/4 (1/4)^(1/3) delta1, F = -5/6 pi w R*, dF/d(delta) goes to -infinity,
// and the grains part. Under a held force they part at y^3 = 3/4, F = -3/2 pi w R*. A cycle of meeting and parting
// loses 7.09 (w^5 R*^4/E*^2)^(1/3) (Thornton and Ning 1998, Powder Technol. 99, 154).
//
// DMT (Derjaguin, Muller and Toporov 1975, J. Colloid Interface Sci. 53, 314; Maugis 1992, ibid. 150, 243):
//   F = 4/3 E* sqrt(R* delta) delta - 2 pi w R*,   delta >= 0
// Without reach the pull ends at delta = 0; with a range z0 it falls as that of van der Waals' forces between spheres,
// by (z0/(z0 + gap))^2, shifted and stretched so that it is continuous at contact and zero at reach = 9 z0. Tabor's
// number (R* w^2/(E*^2 z0^3))^(1/3) says which: JKR above 5, DMT below 0.1.
//
// w, J/m^2, is the work of adhesion of the pair; E* in 1/E* = sum (1 - nu^2)/E, Pa; 1/R* = 1/R1 + 1/R2, m.
#pragma once

#include <cmath>

#include "rvelab/interaction/arithmetic.hpp"

namespace rvelab::interaction {

/// Of two surface energies (J/m^2), by Berthelot's rule: 2 sqrt(g1 g2), which is 2 g for like grains.
inline double work_of_adhesion(double surface_energy_1, double surface_energy_2) {
  return 2 * std::sqrt(surface_energy_1 * surface_energy_2);
}

inline double tabor_number(double work, double modulus, double radius, double range) {
  return cube_root(radius * work * work / (modulus * modulus)) / range;
}

/// Force of a pair, its slope over the overlap, and its energy over that of grains apart.
struct Adhesive {
  double force = 0;           ///< N, positive in compression
  double stiffness = 0;       ///< dF/d(overlap), N/m
  double energy = 0;          ///< J
  double contact_radius = 0;  ///< m; tangential stiffness is 8 G* times it (Mindlin)
};

/// What JKR makes of two grains. Kept for a pair: it costs a cube root.
struct Jkr {
  double force_scale = 0;    ///< 4 pi w R*, N
  double overlap_scale = 0;  ///< a1^2/R*, m
  double radius_scale = 0;   ///< a1, m

  double pull_off() const { return 0.375 * force_scale; }                   ///< 3/2 pi w R*: parts them at held force
  double pull_off_at_held_gap() const { return 5.0 / 24.0 * force_scale; }  ///< 5/6 pi w R*
  double reach() const { return -least_overlap * overlap_scale; }           ///< gap at which they part, m
  /// Do they touch, if they did before or not?
  bool touching(bool before, double overlap) const { return overlap >= 0 || (before && overlap >= -reach()); }

  static constexpr double least_y = 0.62996052494743658;                ///< (1/4)^(1/3)
  static constexpr double least_overlap = -0.75 * least_y;              ///< of y^4 - y
  static constexpr double energy_scale_at_parting = 0.1 / 4 * least_y;  ///< U/(F1 delta1) where they part
};

/// w > 0, E* > 0, R* > 0.
inline Jkr jkr(double work, double modulus, double radius) {
  constexpr double pi = 3.14159265358979323846;
  const double a1 = cube_root(2 * pi * work * radius * radius / modulus);
  return {4 * pi * work * radius, a1 * a1 / radius, a1};
}

/// y of an overlap over delta1, on the branch that is stable at held gap: y^4 - y = overlap, y >= (1/4)^(1/3).
/// With y = y0 + u it is u sqrt(6 y0^2 + 4 y0 u + u^2) = sqrt(overlap - least), convex and regular: Newton's steps from
/// above fall to the root.
inline double jkr_root(double overlap_ratio) {
  constexpr double y0 = Jkr::least_y;
  const double above = overlap_ratio - Jkr::least_overlap;
  if (!(above > 0)) return y0;
  const double wanted = std::sqrt(above);
  const double near = wanted / (2.44948974278317810 * y0),
               far = std::sqrt(wanted);  // neglecting u, or y0: both too far
  double u = near < far ? near : far;
  for (int step = 0; step < 12; ++step) {
    const double inside = 6 * y0 * y0 + u * (4 * y0 + u), root = std::sqrt(inside);
    const double slope = root + u * (2 * y0 + u) / root;
    const double next = u - (u * root - wanted) / slope;
    if (!(next < u)) break;
    u = next;
  }
  return y0 + u;
}

/// Of touching grains (Jkr::touching); overlap, m, at least -reach(). At -reach() itself the stiffness is -infinity.
inline Adhesive jkr_force(const Jkr& pair, double overlap) {
  const double y = jkr_root(overlap / pair.overlap_scale), y2 = y * y, y3 = y2 * y;
  const double rise = 4 * y3 - 1;
  Adhesive out;
  out.force = pair.force_scale * y3 * (2.0 / 3.0 * y3 - 1);
  out.stiffness = pair.force_scale / pair.overlap_scale * y2 * (4 * y3 - 3) / (rise > 0 ? rise : 0.0);
  out.energy = pair.force_scale * pair.overlap_scale * y2 * y2 * ((4.0 / 15.0 * y3 - 2.0 / 3.0) * y3 + 0.25);
  out.contact_radius = pair.radius_scale * y2;
  return out;
}

/// The force that friction goes with: F + 2 pull-off (Thornton 1991, J. Phys. D 24, 1942).
inline double jkr_pressing_force(const Jkr& pair, double force) { return force + 2 * pair.pull_off(); }

struct Dmt {
  double stiffness = 0;  ///< 4/3 E* sqrt(R*), N/m^1.5
  double pull_off = 0;   ///< 2 pi w R*, N
  double range = 0;      ///< z0, m; 0: no reach
  double radius = 0;     ///< R*, m

  static constexpr double reach_over_range = 9;  ///< where van der Waals' pull is a hundredth
  double reach() const { return reach_over_range * range; }
};

inline Dmt dmt(double work, double modulus, double radius, double range = 0) {
  constexpr double pi = 3.14159265358979323846;
  return {4.0 / 3.0 * modulus * std::sqrt(radius), 2 * pi * work * radius, range, radius};
}

/// At any overlap, m, or gap (negative overlap).
inline Adhesive dmt_force(const Dmt& pair, double overlap) {
  // Pull over pull-off: ((z0/(z0 + gap))^2 - c)/(1 - c), c its value at the reach; its integral from the gap to there.
  constexpr double far = 1 + Dmt::reach_over_range, cut = 1 / (far * far);
  const double whole_work = pair.pull_off * pair.range * ((1 - 1 / far) - cut * Dmt::reach_over_range) / (1 - cut);
  Adhesive out;
  if (overlap >= 0) {
    const double root = std::sqrt(overlap), hertz = pair.stiffness * overlap * root;
    out.force = hertz - pair.pull_off;
    out.stiffness = 1.5 * pair.stiffness * root;
    out.energy = 0.4 * hertz * overlap - pair.pull_off * overlap - whole_work;
    out.contact_radius = std::sqrt(pair.radius * overlap);
  } else if (-overlap < pair.reach()) {
    const double far_off = 1 - overlap / pair.range, share = 1 / far_off;
    out.force = -pair.pull_off * (share * share - cut) / (1 - cut);
    out.stiffness = -2 * pair.pull_off / pair.range * share * share * share / (1 - cut);
    out.energy = -pair.pull_off * pair.range * ((share - 1 / far) - cut * (far - far_off)) / (1 - cut);
  }
  return out;
}

/// The force that friction goes with: that of Hertz, F + 2 pi w R*.
inline double dmt_pressing_force(const Dmt& pair, double force) { return force + pair.pull_off; }

}  // namespace rvelab::interaction
