#include "rvelab/protocol/dissolution.hpp"

#include <algorithm>
#include <cmath>

#include "rvelab/error.hpp"
#include "rvelab/protocol/pair_numbers.hpp"

namespace rvelab::protocol {

namespace {

/// The material of that name, -1 if there is none.
std::int32_t material_named(const Specimen& s, const std::string& name) {
  for (std::size_t m = 0; m < s.materials.size(); ++m)
    if (s.materials[m].name == name) return std::int32_t(m);
  return -1;
}

/// What is left of a bond: of its radius, of its strengths. `gap`, `length`: of its grains and of its branch now, m.
struct Left {
  double radius, strength, gap, length, thickness;
  double area() const { return thickness > 0 ? radius : radius * radius; }
};

/// Half f^2/k.
double energy_of(double squared_force, double stiffness) { return stiffness > 0 ? 0.5 * squared_force / stiffness : 0; }
double squared(const double* vector) { return vector[0] * vector[0] + (vector[1] * vector[1] + vector[2] * vector[2]); }
void scale(double* vector, double factor) {
  for (int k = 0; k < 3; ++k) vector[k] *= factor;
}

/// Beams of any criterion. Of a disc A goes with R, I with R^3; of a sphere with R^2 and R^4.
void shrink_beam(double* column, const Left& left) {
  using B = ParallelBond;
  const InteractionStiffness before = B::stiffness([&](int k) { return column[k]; }, left.gap, left.thickness);
  const double area = left.area(), inertia = area * (left.radius * left.radius);
  const double normal = before.normal * (column[B::length] - left.length);
  column[B::released] += (1 - area) * (energy_of(normal * normal, before.normal) +
                                       energy_of(squared(column + B::shear_force), before.tangential)) +
                         (1 - inertia) * (energy_of(squared(column + B::bending_moment), before.bending) +
                                          energy_of(std::pow(column[B::twisting_moment], 2), before.twisting));
  column[B::radius] *= left.radius;
  scale(column + B::shear_force, area);
  scale(column + B::bending_moment, inertia);
  column[B::twisting_moment] *= inertia;
}
void weaken(ParallelBond, double* column, const Left& left) {
  if (left.radius < 1) shrink_beam(column, left);
  column[ParallelBond::tensile_strength] *= left.strength;
  column[ParallelBond::cohesion] *= left.strength;
}
void weaken(SurfaceBond, double* column, const Left& left) {
  if (left.radius < 1) shrink_beam(column, left);
  column[SurfaceBond::tensile_strength] *= left.strength;
}
void weaken(SofteningBond, double* column, const Left& left) {
  using B = SofteningBond;
  const auto energy = [&] { return B::energy([&](int k) { return column[k]; }, left.gap, left.thickness); };
  const double before = energy(), area = left.area(), inertia = area * (left.radius * left.radius);
  column[B::radius] *= left.radius;
  scale(column + B::shear_force, area);
  scale(column + B::bending_moment, inertia);
  column[B::twisting_moment] *= inertia;
  column[B::released] += before - energy();
  column[B::tensile_strength] *= left.strength;
  column[B::cohesion] *= left.strength;
}
void weaken(ContactBond, double* column, const Left& left) {
  using B = ContactBond;
  const double area = left.area(), pull = std::max(left.gap - column[B::first_gap], 0.0);
  column[B::released] += (1 - area) * (0.5 * column[B::normal_stiffness] * pull * pull +
                                       energy_of(squared(column + B::shear_force), column[B::shear_stiffness]));
  for (const int of_section : {B::normal_stiffness, B::shear_stiffness, B::tensile_strength, B::shear_strength})
    column[of_section] *= area;
  scale(column + B::shear_force, area);
  column[B::tensile_strength] *= left.strength;
  column[B::shear_strength] *= left.strength;
}

/// Breaks the bond if it does not bear what it carries where its grains are: a state at rest makes no sub-step in which
/// its law would be asked.
template <class B>
void judge(double* column, const Vector3& branch, double ri, double rj, double thickness) {
  InteractionArrays one;
  one.radius_i = &ri;
  one.radius_j = &rj;
  for (int k = 0; k < interaction_columns<B>(); ++k) one.column[k] = column + k;
  one.thickness = thickness;
  const double length = branch.norm(), before = column[B::released];
  column[B::released] = 0;
  if (thickness > 0) {
    B::template in_plane<true, double>(one, 0, {length});
  } else {
    Triple<double> turned[2] = {load_vec<double>(one.column + B::shear_force, 0), {0, 0, 0}};
    if constexpr (requires { B::bending_moment; }) turned[1] = load_vec<double>(one.column + B::bending_moment, 0);
    B::template in_space<true, double>(one, 0, {{branch[0] / length, branch[1] / length, branch[2] / length}, length},
                                       turned);
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
  each_interaction_law([&](auto, auto law) {
    using Law = decltype(law);
    if constexpr (Law::family == Family::bonds) {
      double column[interaction_columns<Law>()];
      for (Interaction<Law>& bond : static_cast<ListOf<Law>&>(result.interactions).items) {
        const auto i = std::size_t(bond.i), j = std::size_t(bond.j);
        put_columns<Law>(bond, column);
        if (column[Law::broken] != 0) continue;
        if (material >= 0 && s.grains.material[i] != material && s.grains.material[j] != material) continue;
        if (!(numbers_of_pair(s, bond, dissolution.seed, Draw::dissolution)() < dissolution.share)) continue;
        ++result.bonds;
        const Vector3 branch = s.grains.position[j] + translation(s.cell, bond.image) - s.grains.position[i];
        const double ri = s.grains.radius[i], rj = s.grains.radius[j], length = branch.norm();
        weaken(law, column, {radius, strength, length - (ri + rj), length, thickness});
        judge<Law>(column, branch, ri, rj, thickness);
        take_columns<Law>(column, bond);
      }
    }
  });
  return result;
}

}  // namespace rvelab::protocol
