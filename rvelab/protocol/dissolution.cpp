#include "rvelab/protocol/dissolution.hpp"

#include <algorithm>
#include <cmath>

#include "rvelab/error.hpp"
#include "rvelab/protocol/pair_numbers.hpp"

namespace rvelab::protocol {

namespace {

using Bond = Interaction<ParallelBond>;

/// The material of that name, -1 if there is none.
std::int32_t material_named(const Specimen& s, const std::string& name) {
  for (std::size_t m = 0; m < s.materials.size(); ++m)
    if (s.materials[m].name == name) return std::int32_t(m);
  return -1;
}

/// Half f^2/k.
double energy_of(double squared_force, double stiffness) { return stiffness > 0 ? 0.5 * squared_force / stiffness : 0; }
double squared(const double* vector) { return vector[0] * vector[0] + (vector[1] * vector[1] + vector[2] * vector[2]); }

/// The bond with the radius `left` times what it was. `length`: of its branch now, m.
void shrink(double* column, double left, double length, double thickness) {
  using B = ParallelBond;
  const InteractionStiffness before = B::stiffness([&](int k) { return column[k]; }, 0, thickness);
  // Of a disc A goes with R, I with R^3; of a sphere with R^2 and R^4.
  const double area = thickness > 0 ? left : left * left, inertia = area * (left * left);
  const double normal = before.normal * (column[B::length] - length);
  column[B::released] += (1 - area) * (energy_of(normal * normal, before.normal) +
                                       energy_of(squared(column + B::shear_force), before.tangential)) +
                         (1 - inertia) * (energy_of(squared(column + B::bending_moment), before.bending) +
                                          energy_of(std::pow(column[B::twisting_moment], 2), before.twisting));
  column[B::radius] *= left;
  for (int k = 0; k < 3; ++k) {
    column[B::shear_force + k] *= area;
    column[B::bending_moment + k] *= inertia;
  }
  column[B::twisting_moment] *= inertia;
}

/// Breaks the bond if it does not bear what it carries where its grains are: a state at rest makes no sub-step in which
/// its law would be asked.
void judge(double* column, const Vector3& branch, double thickness) {
  using B = ParallelBond;
  InteractionArrays one;
  for (int k = 0; k < interaction_columns<B>(); ++k) one.column[k] = column + k;
  one.thickness = thickness;
  const double length = branch.norm(), before = column[B::released];
  column[B::released] = 0;
  if (thickness > 0) {
    B::in_plane<true, double>(one, 0, {length});
  } else {
    const Triple<double> turned[] = {load_triple<double>(one.column + B::shear_force, 0),
                                     load_triple<double>(one.column + B::bending_moment, 0)};
    B::in_space<true, double>(one, 0, {{branch[0] / length, branch[1] / length, branch[2] / length}, length}, turned);
  }
  column[B::released] += before;
}

}  // namespace

std::string lacking_in(const Specimen& specimen, const Dissolution& dissolution) {
  const std::string& name = dissolution.material;
  if (name.empty() || material_named(specimen, name) >= 0) return "";
  std::string names;
  for (const Material& material : specimen.materials) names += (names.empty() ? "" : ", ") + material.name;
  return "material = \"" + name + "\" is none of the specimen; allowed: " + names;
}

Dissolved dissolved(const Rve& rve, const Dissolution& dissolution, double before, double part) {
  const Specimen s = rve.specimen();
  if (const std::string mistake = lacking_in(s, dissolution); !mistake.empty()) throw InputError(mistake);
  const std::int32_t material = material_named(s, dissolution.material);
  const double thickness = s.cell.dimension == 2 ? s.cell.lattice(2, 2) : 0;
  const auto left = [&](double end) { return (1 - (1 - end) * part) / (1 - (1 - end) * before); };
  const double radius = left(dissolution.radius), strength = left(dissolution.strength);
  Dissolved result{rve.interactions(), 0};
  double column[interaction_columns<ParallelBond>()];
  for (Bond& bond : static_cast<ListOf<ParallelBond>&>(result.interactions).items) {
    const auto i = std::size_t(bond.i), j = std::size_t(bond.j);
    put_columns<ParallelBond>(bond, column);
    if (column[ParallelBond::broken] != 0) continue;
    if (material >= 0 && s.grains.material[i] != material && s.grains.material[j] != material) continue;
    if (!(numbers_of_pair(s, bond, dissolution.seed, Draw::dissolution)() < dissolution.share)) continue;
    ++result.bonds;
    const Vector3 branch = s.grains.position[j] + translation(s.cell, bond.image) - s.grains.position[i];
    if (radius < 1) shrink(column, radius, branch.norm(), thickness);
    column[ParallelBond::tensile_strength] *= strength;
    column[ParallelBond::cohesion] *= strength;
    judge(column, branch, thickness);
    take_columns<ParallelBond>(column, bond);
  }
  return result;
}

}  // namespace rvelab::protocol
