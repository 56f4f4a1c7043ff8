// What changes a bond's strength: scatter from bond to bond, softening by damage, dissolution.
//
// Weibull: P(strength < x) = 1 - exp(-(x/x0)^m). The factor here has mean 1, x0 = 1/Gamma(1 + 1/m). It is drawn from a
// hash of seed and ids, so that it depends on no order, no thread and no rank.
//
// Softening: the springs of a bond are followed as if it were whole, with the share r of its strength that they would
// use (bond.hpp). From r = 1 on it carries (1 - D) of them; D grows with the largest r there was,
//   D = r_f (r - 1)/(r (r_f - 1)),   r_f = 2 G kn/sigma_c^2
// which in tension is a straight line from sigma_c at the opening sigma_c/kn down to zero at 2 G/sigma_c, so that
// G (J/m^2) is spent (Hillerborg, Modeer and Petersson 1976, Cem. Concr. Res. 6, 773). Other modes soften over the same
// r_f; in compression the normal force is carried whole. r_f <= 1 is brittle.
//
// Dissolution: the rim recedes at a rate, R = R_0 - rate t, and what it carried goes with it, the stress of the rest
// being as it was; or strength falls, 1 - rate t.
#pragma once

#include <cmath>
#include <cstdint>

#include "rvelab/interaction/bond.hpp"

namespace rvelab::interaction {

/// Above 0 and below 1, the same for (i, j) and (j, i). `image` tells bonds of one pair through different images apart.
inline double pair_uniform(std::uint64_t seed, std::uint64_t i, std::uint64_t j, std::uint64_t image = 0) {
  const auto mixed = [](std::uint64_t x) {  // the finaliser of SplitMix64 (Steele, Lea and Flood 2014)
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
  };
  const std::uint64_t low = i < j ? i : j, high = i < j ? j : i;
  const std::uint64_t hash = mixed(mixed(mixed(mixed(seed) ^ low) ^ high) ^ image);
  return (double(hash >> 11) + 0.5) * 0x1p-53;
}

/// Strength over its mean, of Weibull's modulus m > 0, for a number between 0 and 1.
inline double weibull_factor(double uniform, double modulus) {
  return std::pow(-std::log(uniform), 1 / modulus) / std::tgamma(1 + 1 / modulus);
}

/// r_f of a fracture energy (J/m^2), kn per area (Pa/m) and tensile strength (Pa).
inline double softening_end(double fracture_energy, double kn, double tensile) {
  return 2 * fracture_energy * kn / (tensile * tensile);
}
/// D of the largest share there was: 0 to 1.
inline double bond_damage(double largest_share, double end) {
  if (largest_share <= 1) return 0;
  if (largest_share >= end) return 1;
  return end * (largest_share - 1) / (largest_share * (end - 1));
}
/// What a damaged bond carries of the forces of the whole one.
inline BondForces damaged(BondForces whole, double damage) {
  const double left = 1 - damage;
  if (whole.normal < 0) whole.normal *= left;
  for (int c = 0; c < 3; ++c) {
    whole.shear[c] *= left;
    whole.bending[c] *= left;
  }
  whole.twist *= left;
  return whole;
}
inline PlanarBondForces damaged(const PlanarBondForces& whole, double damage) {
  const double left = 1 - damage;
  return {whole.normal < 0 ? left * whole.normal : whole.normal, left * whole.shear, left * whole.bending};
}
/// Energy stored in a damaged bond, from the forces of the whole one, J.
inline double damaged_energy(const BondStiffness& k, BondLoad whole, double damage) {
  const double pressed = whole.normal > 0 ? 0.5 * whole.normal * whole.normal / k.normal : 0;
  if (whole.normal > 0) whole.normal = 0;
  return pressed + (1 - damage) * bond_energy(k, whole);
}

/// Radius after `time` at `rate`, m/s; 0: dissolved.
inline double dissolved_radius(double radius, double rate, double time) {
  const double left = radius - rate * time;
  return left > 0 ? left : 0;
}
/// Part of the strength left after `time` at `rate`, 1/s.
inline double dissolved_strength(double rate, double time) {
  const double left = 1 - rate * time;
  return left > 0 ? left : 0;
}
/// What is left in a bond whose section shrinks.
inline BondForces shrunk(BondForces forces, const BondSection& before, const BondSection& after) {
  const double area = after.area / before.area, inertia = after.inertia / before.inertia;
  forces.normal *= area;
  for (int c = 0; c < 3; ++c) {
    forces.shear[c] *= area;
    forces.bending[c] *= inertia;
  }
  forces.twist *= before.polar > 0 ? after.polar / before.polar : 0;
  return forces;
}
inline PlanarBondForces shrunk(const PlanarBondForces& forces, const BondSection& before, const BondSection& after) {
  const double area = after.area / before.area;
  return {forces.normal * area, forces.shear * area, forces.bending * (after.inertia / before.inertia)};
}

}  // namespace rvelab::interaction
