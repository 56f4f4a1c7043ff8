// The contact of two rocks, of a rock and a boundary, or of a rock and the ball of a material point: Hertz-Mindlin with
// Coulomb friction and a coefficient of restitution (Li et al. 2023, eq. 18 to 21).
//
//   space   f_n = 4/3 E* sqrt(r* delta) delta,   k_t = 8 G* sqrt(r* delta)
//   plane   f_n = pi/4 E* l delta,               k_t = pi G* l        (discs of the thickness l: parallel cylinders)
//   f_t <- f_t s - k_t du_t,  |f_t| <= mu |f_n|,  s = sqrt(delta/delta_old) where the overlap falls, else 1
//   dashpots c_n = cn delta^(1/4) in space, cn in the plane; along the contact the same
//
// 1/E* = sum (1 - nu^2)/E, 1/G* = sum 2 (2 - nu)(1 + nu)/E, 1/r* = sum 1/r. s: without it energy is made on unloading
// (space; in the plane k_t is constant and s = 1). The dashpot is that of a restitution e at any speed (Antypov and
// Elliott 2011): cn = sqrt(5) zeta sqrt(m* k), in the plane 2 zeta sqrt(m* k), zeta = -ln e/sqrt(pi^2 + ln^2 e).
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "rvelab/contact/hertz_mindlin.hpp"
#include "tools/mpm/tensors.hpp"

namespace mpm {

/// What a rock is made of.
struct RockMaterial {
  double young_modulus = 0, poisson_ratio = 0;  ///< Pa, 1
  double friction = 0, restitution = 1;
};

/// How soil and rocks touch.
struct RockSoil {
  bool ghosts = false;  ///< points as balls with a stiffness; else at the surface, without
  bool rough = false;   ///< no slip while it is pressed
  double friction = 0.3;
  // of ghosts
  double porosity = 0;  ///< of the soil: its solids make the ball
  bool moment = true;   ///< the moment of the contact force about the point reaches the grid
  RockMaterial ball;    ///< of the points; no Young's modulus: that of the rock
};

/// Constants of one pair: f_n = k delta^(3/2) or k delta.
template <int D>
struct RockPair {
  using Law = rvelab::HertzMindlinLaw;
  double k = 0, kt = 0;  ///< space: before delta^(3/2) and sqrt(delta); plane: N/m
  double friction = 0;
  double damping = 0;  ///< cn

  /// `ri`, `rj`: m, of curvature; infinite for a plane. `mass`: kg, m* of the pair. `thickness`: m, in the plane.
  RockPair(const RockMaterial& a, double ri, const RockMaterial& b, double rj, double mass, double thickness) {
    // Of r* = 1 m they are 4/3 E* and 8 G*. A plane is a sphere so large that r* is the other's, to the last bit.
    const rvelab::ContactConstants constants =
        D == 2 ? Law::mix(a, 2, b, 2, 0) : Law::mix(a, ri, b, std::min(rj, 1e30 * ri), 0);
    k = D == 2 ? 0.1875 * std::numbers::pi * constants.kn * thickness : constants.kn;
    kt = D == 2 ? 0.125 * std::numbers::pi * constants.kt * thickness : constants.kt;
    friction = std::min(a.friction, b.friction);
    const double e = std::min(a.restitution, b.restitution);
    if (e >= 1) return;
    const double log = std::log(std::max(e, 1e-3));
    const double zeta = -log / std::sqrt(std::numbers::pi * std::numbers::pi + log * log);
    damping = (D == 2 ? 2 : std::sqrt(5.0)) * zeta * std::sqrt(mass * k);
  }
  double normal_force(double overlap) const {
    return D == 2 ? k * overlap : Law::Force::normal_force(k, overlap, std::sqrt(overlap), 0.0);
  }
  double normal_energy(double overlap) const {
    return D == 2 ? 0.5 * normal_force(overlap) * overlap
                  : Law::Force::normal_energy(k, overlap, std::sqrt(overlap), 0.0);
  }
  /// N/m, of a further overlap.
  double normal_stiffness(double overlap) const {
    return D == 2 ? k : Law::Force::normal_stiffness(k, std::sqrt(overlap));
  }
  double tangential_stiffness(double overlap) const {
    return D == 2 ? kt : Law::Force::tangential_stiffness(kt, std::sqrt(overlap));
  }
  double dashpot(double overlap) const { return D == 2 ? damping : damping * std::sqrt(std::sqrt(overlap)); }
  /// m, of a mass (kg) that comes at a speed (m/s) and is stopped by the spring.
  double reach(double mass, double speed) const {
    return D == 2 ? speed * std::sqrt(mass / k) : std::pow(1.25 * mass * speed * speed / k, 0.4);
  }
};

/// A contact's memory, and what it holds and has lost.
template <int D>
struct RockContact {
  Vec<D> tangential = Vec<D>::Zero();  ///< N, elastic part of the force along the contact, on the second body
  double overlap = 0;                  ///< m, at the end of the sub-step before; 0: none
  Vec<D> dashpot = Vec<D>::Zero();     ///< N, its part of the force at the end of the sub-step before

  /// Force on the second body (N) at the end of a sub-step that takes the overlap to `now` (m). normal: from the first
  /// to the second; relative: m/s, velocity of the second at the contact less that of the first, half a sub-step
  /// before. loss: J, grows by what friction and dashpots take, and by what a tangential spring loses as its stiffness
  /// changes.
  Vec<D> advance(const RockPair<D>& pair, double now, const Vec<D>& normal, const Vec<D>& relative, double dt,
                 double& loss) {
    const double across = relative.dot(normal), stiffness = pair.tangential_stiffness(now);
    const Vec<D> slip = relative - across * normal;
    const double held = tangential_energy(pair);
    const Vec<D> last = tangential;
    if (D == 3 && overlap > 0 && now < overlap) tangential *= std::sqrt(now / overlap);
    const double before = tangential.norm();
    tangential -= tangential.dot(normal) * normal;
    if (const double turned = tangential.norm(); turned > 0) tangential *= before / turned;
    overlap = now;
    loss += held - tangential_energy(pair);
    const double damping = pair.dashpot(now), push = pair.normal_force(now) - damping * across;
    const Vec<D> from = tangential;
    // Over the sub-step both ends' forces do the work: that of `last`, not of `from`.
    loss += 0.5 * dt * (from - last).dot(slip);
    tangential -= stiffness * dt * slip;
    Vec<D> along = tangential - damping * slip;
    const double most = pair.friction * std::abs(push), size = along.norm();
    if (size > most) {
      along *= most / size;
      const Vec<D> kept = along + damping * slip;
      if (stiffness > 0) loss += 0.5 * (from + kept).dot(tangential - kept) / stiffness;
      tangential = kept;
    }
    const Vec<D> dashed = -damping * relative;
    loss -= 0.5 * dt * (dashpot + dashed).dot(relative);
    dashpot = dashed;
    return push * normal + along;
  }
  /// J, lost as the two part: what the spring along the contact holds, and the last half sub-step of the dashpot.
  double end_loss(const RockPair<D>& pair, const Vec<D>& relative, double dt) const {
    return tangential_energy(pair) - 0.5 * dt * dashpot.dot(relative);
  }
  double tangential_energy(const RockPair<D>& pair) const {
    const double stiffness = overlap > 0 ? pair.tangential_stiffness(overlap) : 0;
    return stiffness > 0 ? 0.5 * tangential.squaredNorm() / stiffness : 0;
  }
  /// J, in the springs.
  double energy(const RockPair<D>& pair) const {
    return overlap > 0 ? pair.normal_energy(overlap) + tangential_energy(pair) : 0;
  }
};

}  // namespace mpm
