// The states from which the increments of rvelab-estimates are made.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "rvelab/error.hpp"
#include "rvelab/pack/search.hpp"
#include "rvelab/protocol/cementation.hpp"
#include "rvelab/protocol/drive.hpp"
#include "rvelab/solver/rve.hpp"
#include "tools/validate.d/estimates_recipes.hpp"

namespace rvelab::estimates {

/// Cement of about the stiffness of the contacts, whose bonds break at one to five times the forces of the packing at
/// rest; bridges whose pull is 0.1 to 1 of these.
inline protocol::Cementation drawn_cement(std::uint64_t seed, double kappa) {
  Random random(seed, 1);
  protocol::Cementation cement;
  cement.gap = random.chance(0.5) ? 0 : random(0, 0.05);
  cement.share = random(0.6, 1);
  cement.seed = seed;
  cement.radius = random(0.5, 1);
  cement.young_modulus = pressure * kappa * random.power(-0.5, 0.5);
  cement.tensile_strength = pressure * random.power(0, 0.7);
  cement.cohesion = cement.tensile_strength * random.power(0, 0.5);
  cement.friction_angle_deg = random(0, 35);
  cement.moment_factor = random(0, 1);
  cement.strength_scatter = random.chance(0.5) ? random(0.1, 0.4) : 0;
  return cement;
}
inline Water drawn_water(std::uint64_t seed) {
  Random random(seed, 1);
  Water water;
  water.contact_angle_deg = random(0, 30);
  water.surface_tension = pressure * mean_radius * random.power(-1, 0) * 0.6;  // 2 pi r gamma over p (2 r)^2
  if (seed % 5 == 4)
    water.volume_ratio = random.power(-4, -1.7);
  else
    water.suction = water.surface_tension / (mean_radius * random.power(-1.5, -0.5));
  return water;
}

/// As the stage `water` does; none: as its removal does.
inline void set_water(Rve& rve, const std::vector<Water>& water) {
  Interactions all = rve.interactions();
  auto& bridges = static_cast<ListOf<CapillaryBridge>&>(all);
  bridges.settings = water;
  if (water.empty()) bridges.items.clear();
  rve.set_interactions(all);
}

/// A recipe that comes to no rest is drawn again.
inline Specimen packed(pack::Recipe recipe) {
  Workers alone(1);
  for (int draws = 1;; ++draws) {
    try {
      Rve rve(pack::pack(recipe, alone).specimen);
      if (!rve.relax(1e-7, 300'000).target_held) throw IncrementFailed("the packing does not come to rest");
      return rve.specimen();
    } catch (const IncrementFailed&) {
      if (draws == 5) throw;
      recipe.seed += 1000;
    }
  }
}

inline void compress(Rve& rve, const Matrix3& held_stress, double step, bool first) {
  const int dimension = rve.cell().dimension, axis = dimension - 1;
  std::vector<protocol::HeldStress> held;
  for (int i = 0; i < axis; ++i) held.push_back({i, i, held_stress(i, i), std::abs(held_stress(i, i))});
  Matrix3 gradient = Matrix3::Zero();
  gradient(axis, axis) = -step;
  rve.apply(protocol::mixed_target(gradient, held, rve.stress(), dimension, !first), 0);
}

inline std::size_t broken_bonds(const Rve& rve) {
  std::size_t broken = 0;
  double columns[interaction_columns<ParallelBond>()];
  const Interactions all = rve.interactions();
  for (const auto& bond : static_cast<const ListOf<ParallelBond>&>(all).items) {
    put_columns<ParallelBond>(bond, columns);
    broken += columns[ParallelBond::broken] != 0;
  }
  return broken;
}

/// Cemented: in drained compression to 3 % half way to the first break, just before the peak, and at the end. Moist: at
/// rest, after 2 %, and flooded there, without relaxation. Held stresses are those of the packing at rest before.
inline std::vector<Specimen> interacting_states(std::uint64_t seed) {
  const Drawn d = drawn(seed);
  Rve rve(packed(d.recipe));
  const Matrix3 start = rve.stress();
  const int axis = rve.cell().dimension - 1;
  std::vector<Specimen> states;
  if (is_cemented(seed)) {
    rve.set_interactions(protocol::cemented(rve, drawn_cement(seed, d.kappa)));
    std::vector<Specimen> path{rve.specimen()};
    std::size_t intact = 0, peak = 0;
    double strongest = 0;
    for (int k = 0; k < 150; ++k) {
      compress(rve, start, 2e-4, k == 0);
      path.push_back(rve.specimen());
      if (broken_bonds(rve) == 0) intact = path.size() - 1;
      if (-rve.stress()(axis, axis) > strongest) strongest = -rve.stress()(axis, axis), peak = path.size() - 1;
    }
    return {path[intact / 2], path[peak > 0 ? peak - 1 : 0], path.back()};
  }
  set_water(rve, {drawn_water(seed)});
  if (!rve.relax(1e-7, 300'000).target_held) throw IncrementFailed("the moist packing does not come to rest");
  states.push_back(rve.specimen());
  for (int k = 0; k < 100; ++k) compress(rve, start, 2e-4, k == 0);
  states.push_back(rve.specimen());
  set_water(rve, {});
  states.push_back(rve.specimen());
  return states;
}

/// At rest, after a fifth and at the end of a drained compression. That of a stiff one is a tenth as long, and its rate
/// follows no tolerance but near those two: x = strain/overlap is more than a thousand even so.
inline std::vector<Specimen> states_of(std::uint64_t seed) {
  if (is_interacting(seed)) return interacting_states(seed);
  const Drawn d = drawn(seed);
  std::vector<Specimen> states{packed(d.recipe)};
  const int dimension = dimension_of(d.recipe.shape), axis = dimension - 1;
  Rve rve(states[0]);
  const Matrix3 start = rve.stress();
  const double step = d.kappa > stiff ? 5e-5 : 5e-4;
  for (int k = 1; k <= 100; ++k) {
    const bool coarse = d.kappa > stiff / 5 && k != 19 && k != 20 && k < 99;
    Specimen s = rve.specimen();
    if ((s.solver.target_unbalanced > 0) != coarse) {
      s.solver.target_unbalanced = coarse ? 0.05 : 0;
      rve = Rve(s);
    }
    std::vector<protocol::HeldStress> held;
    for (int i = 0; i < axis; ++i) held.push_back({i, i, start(i, i), std::abs(start(i, i))});
    Matrix3 gradient = Matrix3::Zero();
    gradient(axis, axis) = -step;
    rve.apply(protocol::mixed_target(gradient, held, rve.stress(), dimension, k > 1), 0);
    if (k == 20 || k == 100) states.push_back(rve.specimen());
  }
  return states;
}

}  // namespace rvelab::estimates
