#include "rvelab/protocol/cementation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <tuple>

#include "rvelab/protocol/pair_numbers.hpp"
#include "rvelab/solver/assembly/neighbour_list.hpp"

namespace rvelab::protocol {

namespace {

/// A pair that is cemented now.
struct Place {
  double radius_i, radius_j, length;  ///< m, length of the branch
  double thickness;                   ///< m, in the plane
  double strength;                    ///< over its mean
};

/// Of its bond: kn, ks, Pa/m; section.
struct BondNumbers {
  double radius, kn, ks, area, tan_friction;
  BondNumbers(const Cementation& cement, const Place& at)
      : radius(cement.radius * std::min(at.radius_i, at.radius_j)),
        kn(cement.young_modulus / (at.radius_i + at.radius_j)),
        ks(cement.shear_ratio * kn),
        area(at.thickness > 0 ? 2 * radius * at.thickness : std::numbers::pi * radius * radius),
        tan_friction(std::tan(cement.friction_angle_deg * std::numbers::pi / 180)) {}
};

void put_beam(const BondNumbers& bond, const Place& at, double* c) {
  using B = ParallelBond;  // beams of any criterion have these
  c[B::length] = at.length;
  c[B::radius] = bond.radius;
  c[B::normal_stiffness] = bond.kn;
  c[B::shear_stiffness] = bond.ks;
}
void put_bond(ParallelBond, const Cementation& cement, const Place& at, double* c) {
  using B = ParallelBond;
  const BondNumbers bond(cement, at);
  put_beam(bond, at, c);
  c[B::tensile_strength] = at.strength * cement.tensile_strength;
  c[B::cohesion] = at.strength * cement.cohesion;
  c[B::friction] = bond.tan_friction;
  c[B::moment_factor] = cement.moment_factor;
}
void put_bond(SurfaceBond, const Cementation& cement, const Place& at, double* c) {
  using B = SurfaceBond;
  const BondNumbers bond(cement, at);
  put_beam(bond, at, c);
  c[B::tensile_strength] = at.strength * cement.tensile_strength;
  c[B::shear_factor] = bond.tan_friction;
  // Stress linear over the width: I/(A R^2); J is twice I. The factor takes of the moments what counts.
  const double linear = at.thickness > 0 ? 1.0 / 3 : 1.0 / 4, factor = cement.moment_factor;
  c[B::bending_factor] = factor > 0 ? linear / factor : 0;
  c[B::twisting_factor] = factor > 0 && !(at.thickness > 0) ? bond.tan_friction * 2 * linear / factor : 0;
}
void put_bond(SofteningBond, const Cementation& cement, const Place& at, double* c) {
  using B = SofteningBond;
  const BondNumbers bond(cement, at);
  const double tensile = at.strength * cement.tensile_strength;
  c[B::first_gap] = at.length - (at.radius_i + at.radius_j);
  c[B::radius] = bond.radius;
  c[B::normal_stiffness] = bond.kn;
  c[B::shear_stiffness] = bond.ks;
  c[B::tensile_strength] = tensile;
  c[B::cohesion] = at.strength * cement.cohesion;
  c[B::friction] = bond.tan_friction;
  c[B::moment_factor] = cement.moment_factor;
  c[B::last_share] = 2 * cement.fracture_energy * bond.kn / (tensile * tensile);
}
void put_bond(ContactBond, const Cementation& cement, const Place& at, double* c) {
  using B = ContactBond;
  const BondNumbers bond(cement, at);
  c[B::first_gap] = at.length - (at.radius_i + at.radius_j);
  c[B::normal_stiffness] = bond.kn * bond.area;
  c[B::shear_stiffness] = bond.ks * bond.area;
  c[B::tensile_strength] = at.strength * cement.tensile_strength * bond.area;
  c[B::shear_strength] = at.strength * cement.cohesion * bond.area;
  c[B::friction] = bond.tan_friction;
}

/// Pairs with an intact bond of any law but this one.
template <class Own>
std::set<std::tuple<std::int32_t, std::int32_t, Image>> bonded_otherwise(const Interactions& all) {
  std::set<std::tuple<std::int32_t, std::int32_t, Image>> found;
  each_interaction_law([&](auto, auto law) {
    using Law = decltype(law);
    if constexpr (Law::family == Family::bonds && !std::is_same_v<Law, Own>) {
      double columns[interaction_columns<Law>()];
      for (const Interaction<Law>& bond : static_cast<const ListOf<Law>&>(all).items) {
        put_columns<Law>(bond, columns);
        if (columns[Law::broken] == 0) found.insert({bond.i, bond.j, bond.image});
      }
    }
  });
  return found;
}

template <class Law>
void add_bonds(const Specimen& s, const Cementation& cement, Interactions& all) {
  using Bond = Interaction<Law>;
  const auto& radius = s.grains.radius;
  std::vector<double> positions;
  for (const Vector3& x : s.grains.position) positions.insert(positions.end(), {x[0], x[1], x[2]});
  const double largest = *std::max_element(radius.begin(), radius.end());
  std::vector<Bond>& bonds = static_cast<ListOf<Law>&>(all).items;
  const std::vector<Bond> before = std::move(bonds);
  bonds.clear();
  const auto others = bonded_otherwise<Law>(all);
  const double modulus = cement.strength_scatter > 0 ? weibull_modulus(cement.strength_scatter) : 0;
  auto old = before.begin();
  double columns[interaction_columns<Law>()];
  // A skin above the largest gap asked for: the list leaves out pairs at the skin itself.
  for (const ListedPair& pair : list_pairs(s.cell, positions.data(), 3, radius, (cement.gap + 1e-9) * largest)) {
    Bond bond;
    bond.i = pair.i;
    bond.j = pair.j;
    bond.image = pair.image;
    for (; old != before.end() && pair_of(*old) < pair_of(bond); ++old) bonds.push_back(*old);
    if (old != before.end() && pair_of(*old) == pair_of(bond)) {
      put_columns<Law>(*old, columns);
      if (columns[Law::broken] == 0) {
        bonds.push_back(*old++);
        continue;
      }
    }
    const auto i = std::size_t(bond.i), j = std::size_t(bond.j);
    const double length = (s.grains.position[j] + translation(s.cell, bond.image) - s.grains.position[i]).norm();
    const double smaller = std::min(radius[i], radius[j]);
    Uniform draw = numbers_of_pair(s, bond, cement.seed, Draw::cement);
    if (length - (radius[i] + radius[j]) > cement.gap * smaller || !(draw() < cement.share)) continue;
    if (others.contains({pair.i, pair.j, pair.image})) continue;
    std::fill(std::begin(columns), std::end(columns), 0.0);
    put_bond(Law{}, cement,
             {radius[i], radius[j], length, s.cell.dimension == 2 ? s.cell.lattice(2, 2) : 0,
              modulus > 0 ? weibull_factor(modulus, draw()) : 1.0},
             columns);
    if (old != before.end() && pair_of(*old) == pair_of(bond)) ++old;  // broken: a new one stands in its place
    take_columns<Law>(columns, bond);
    bonds.push_back(bond);
  }
  bonds.insert(bonds.end(), old, before.end());
}

}  // namespace

double weibull_modulus(double scatter) {
  const auto scatter_of = [](double m) {
    return std::sqrt(std::expm1(std::lgamma(1 + 2 / m) - 2 * std::lgamma(1 + 1 / m)));
  };
  double low = 0.4, high = 2000;  // it falls as the modulus grows
  for (int k = 0; k < 100; ++k) {
    const double middle = std::sqrt(low * high);
    (scatter_of(middle) > scatter ? low : high) = middle;
  }
  return std::sqrt(low * high);
}

double weibull_factor(double modulus, double draw) {
  return std::pow(-std::log1p(-draw), 1 / modulus) / std::tgamma(1 + 1 / modulus);
}

Interactions cemented(const Rve& rve, const Cementation& cement) {
  Interactions all = rve.interactions();
  switch (cement.model) {
    case BondModel::parallel:
      add_bonds<ParallelBond>(rve.specimen(), cement, all);
      break;
    case BondModel::surface:
      add_bonds<SurfaceBond>(rve.specimen(), cement, all);
      break;
    case BondModel::softening:
      add_bonds<SofteningBond>(rve.specimen(), cement, all);
      break;
    case BondModel::contact:
      add_bonds<ContactBond>(rve.specimen(), cement, all);
      break;
  }
  return all;
}

}  // namespace rvelab::protocol
