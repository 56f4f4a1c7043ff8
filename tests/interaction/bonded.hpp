// Two grains and crystals with bonds, made by hand.
#pragma once

#include "rvelab/protocol/cementation.hpp"
#include "tests/interaction/settings.hpp"
#include "tests/specimens.hpp"

namespace rvelab::test {

using Bond = Interaction<ParallelBond>;

inline std::vector<Bond>& bonds_of(Interactions& all) { return static_cast<ListOf<ParallelBond>&>(all).items; }
inline std::vector<Bond> bonds_of(const Rve& rve) {
  Interactions all = rve.interactions();
  return bonds_of(all);
}
inline double column(const Bond& bond, int k) {
  double columns[interaction_columns<ParallelBond>()];
  put_columns<ParallelBond>(bond, columns);
  return columns[k];
}
inline Vector3 triple(const Bond& bond, int k) { return {column(bond, k), column(bond, k + 1), column(bond, k + 2)}; }

/// Section and second moments of area, thickness 1 in the plane.
struct Section {
  double area, inertia, polar;
};
inline Section section_of(Shape shape, double radius) {
  if (dimension_of(shape) == 2) return {2 * radius, 2 * std::pow(radius, 3) / 3, 0};
  return {pi * radius * radius, pi * std::pow(radius, 4) / 4, pi * std::pow(radius, 4) / 2};
}

/// Bonds of Young's modulus 1e8 Pa, as strong in tension as in shear (Pa), over gaps up to this part of the smaller
/// radius.
inline protocol::Cementation cement_of(double strength, double gap = 0.05) {
  protocol::Cementation cement;
  cement.gap = gap;
  cement.young_modulus = 1e8;
  cement.tensile_strength = cement.cohesion = strength;
  return cement;
}

/// 81 discs or 125 spheres at rest.
inline Rve small_packing_at_rest(Shape shape, double friction) {
  return at_rest(disordered(shape, dimension_of(shape) == 2 ? 9 : 5, linear_material(2e6, 1e6, friction),
                            Law::linear_stiffness, 0.51, 5),
                 1e-9);
}

}  // namespace rvelab::test
