#include "rvelab/protocol/cementation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "rvelab/protocol/pair_numbers.hpp"
#include "rvelab/solver/assembly/neighbour_list.hpp"

namespace rvelab::protocol {

namespace {

using Bond = Interaction<ParallelBond>;

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
  const Specimen s = rve.specimen();
  const auto& radius = s.grains.radius;
  std::vector<double> positions;
  for (const Vector3& x : s.grains.position) positions.insert(positions.end(), {x[0], x[1], x[2]});
  const double largest = *std::max_element(radius.begin(), radius.end());
  Interactions all = rve.interactions();
  const std::vector<Bond> before = std::move(static_cast<ListOf<ParallelBond>&>(all).items);
  std::vector<Bond>& bonds = static_cast<ListOf<ParallelBond>&>(all).items;
  bonds.clear();
  const double modulus = cement.strength_scatter > 0 ? weibull_modulus(cement.strength_scatter) : 0;
  auto old = before.begin();
  double columns[interaction_columns<ParallelBond>()];
  // A skin above the largest gap asked for: the list leaves out pairs at the skin itself.
  for (const ListedPair& pair : list_pairs(s.cell, positions.data(), 3, radius, (cement.gap + 1e-9) * largest)) {
    Bond bond;
    bond.i = pair.i;
    bond.j = pair.j;
    bond.image = pair.image;
    for (; old != before.end() && pair_of(*old) < pair_of(bond); ++old) bonds.push_back(*old);
    if (old != before.end() && pair_of(*old) == pair_of(bond)) {
      put_columns<ParallelBond>(*old, columns);
      if (columns[ParallelBond::broken] == 0) {
        bonds.push_back(*old++);
        continue;
      }
    }
    const auto i = std::size_t(bond.i), j = std::size_t(bond.j);
    const double length = (s.grains.position[j] + translation(s.cell, bond.image) - s.grains.position[i]).norm();
    const double smaller = std::min(radius[i], radius[j]);
    Uniform draw = numbers_of_pair(s, bond, cement.seed, Draw::cement);
    if (length - (radius[i] + radius[j]) > cement.gap * smaller || !(draw() < cement.share)) continue;
    const double kn = cement.young_modulus / (radius[i] + radius[j]),
                 strength = modulus > 0 ? weibull_factor(modulus, draw()) : 1.0;
    std::fill(std::begin(columns), std::end(columns), 0.0);
    columns[ParallelBond::length] = length;
    columns[ParallelBond::radius] = cement.radius * smaller;
    columns[ParallelBond::normal_stiffness] = kn;
    columns[ParallelBond::shear_stiffness] = cement.shear_ratio * kn;
    columns[ParallelBond::tensile_strength] = strength * cement.tensile_strength;
    columns[ParallelBond::cohesion] = strength * cement.cohesion;
    columns[ParallelBond::friction] = std::tan(cement.friction_angle_deg * std::numbers::pi / 180);
    columns[ParallelBond::moment_factor] = cement.moment_factor;
    if (old != before.end() && pair_of(*old) == pair_of(bond)) ++old;  // broken: a new one stands in its place
    take_columns<ParallelBond>(columns, bond);
    bonds.push_back(bond);
  }
  bonds.insert(bonds.end(), old, before.end());
  return all;
}

}  // namespace rvelab::protocol
