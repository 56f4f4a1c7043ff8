// Packings for rvelab-estimates, drawn by seed, and the states from which their increments are made.
#pragma once

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "rvelab/error.hpp"
#include "rvelab/grains/uniform.hpp"
#include "rvelab/pack/search.hpp"
#include "rvelab/protocol/cementation.hpp"
#include "rvelab/protocol/drive.hpp"
#include "rvelab/solver/rve.hpp"

namespace rvelab::estimates {

constexpr double pressure = 1e5, thickness = 0.1, mean_radius = 5e-3;
constexpr int percents[] = {0, 1, 5};
constexpr double stiff = 1e4;  ///< kn/(p t) beyond which strains are a tenth of that

/// Numbers of a seed, for one purpose each.
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t purpose) : uniform_(seed, purpose + 1) {}
  double operator()(double low, double high) { return low + (high - low) * uniform_(); }
  double power(double low, double high) { return std::pow(10, (*this)(low, high)); }
  bool chance(double share) { return (*this)(0, 1) < share; }

 private:
  Uniform uniform_;
};

struct Drawn {
  pack::Recipe recipe;
  double kappa = 0, ratio = 1, friction = 0;
};

inline Drawn drawn_recipe(std::uint64_t seed) {
  Random random(seed, 0);
  Drawn d;
  pack::Recipe& r = d.recipe;
  const auto kind = (seed / 2) % 6;  // both parities get all
  r.shape = kind < 3 ? Shape::disc : kind < 5 ? Shape::sphere : Shape::ellipse;
  const int dimension = dimension_of(r.shape);
  r.seed = seed;
  r.number = std::size_t(random(dimension == 2 ? 60 : 90, dimension == 2 ? 160 : 180));
  r.thickness = thickness;
  d.ratio = random.power(0.05, 1);
  Grading& grading = r.fractions[0].grading;
  grading.curve = random.chance(0.5) ? GradingCurve::uniform : GradingCurve::linear;
  grading.smallest_radius = 2 * mean_radius / (1 + d.ratio);
  grading.largest_radius = d.ratio * grading.smallest_radius;
  if (r.shape == Shape::ellipse) {
    r.fractions[0].smallest_aspect_ratio = random(0.4, 0.9);
    r.fractions[0].largest_aspect_ratio = 0.95;
  }
  Material& m = r.materials[0];
  const double share = random(0, 1);
  d.friction = m.friction = share < 0.1    ? 0
                            : share < 0.45 ? random.power(-2, -0.7)
                                           : random.power(-0.7, share < 0.9 ? 0 : 1);
  const bool hertz = r.shape != Shape::ellipse && random.chance(0.35);
  d.kappa = random.power(2, hertz ? 4.5 : 6);
  r.contact.law = hertz ? Law::hertz_mindlin : Law::linear_stiffness;
  m.normal_stiffness = d.kappa * pressure * (dimension == 2 ? thickness : 2 * mean_radius);
  m.tangential_stiffness = random(0.2, 1) * m.normal_stiffness;
  m.poisson_ratio = random(0, 0.4);
  m.young_modulus = pressure * d.kappa * std::sqrt(d.kappa);
  r.contact.rolling = m.friction > 0 && random.chance(0.3);
  m.rolling_stiffness = random(0.2, 2);
  m.rolling_friction = random.power(-2, -0.3);
  r.damping.local = 0.1;
  r.solver.max_overlap_ratio = 1;
  r.stress_tolerance = 2e-3;
  r.unbalanced = 1e-4;
  r.stress = pack::isotropic_stress(pressure, r.shape);
  if (random.chance(0.5)) r.preparation.friction = std::min(m.friction, random(0, 0.1));
  return d;
}

/// Seeds from here on: one of five kinds whose long increments an outside check found below 95 % (seed % 5): many discs
/// of little friction, wide Hertz spheres, stiff spheres (overlaps of 1e-4: 10 kPa on 1e8 Pa), ellipses, loose rolling
/// discs. Six of seven increments are of 1e-3 to 1e-2.
constexpr std::uint64_t first_of_kinds = 101;

inline Drawn drawn_kind(std::uint64_t seed) {
  Random random(seed, 0);
  Drawn d;
  pack::Recipe& r = d.recipe;
  const auto kind = seed % 5;
  r.shape = kind == 1 || kind == 2 ? Shape::sphere : kind == 3 ? Shape::ellipse : Shape::disc;
  const int dimension = dimension_of(r.shape);
  r.seed = seed;
  r.number = std::size_t(kind == 0 ? 400 : kind == 4 ? random(150, 250) : random(120, 180));
  r.thickness = thickness;
  d.ratio = kind == 1 ? 0.25 : random(0.4, 0.6);
  Grading& grading = r.fractions[0].grading;
  grading.curve = kind == 1 ? GradingCurve::linear : GradingCurve::uniform;
  grading.smallest_radius = 2 * mean_radius / (1 + 1 / d.ratio);
  grading.largest_radius = grading.smallest_radius / d.ratio;
  if (kind == 3) {
    r.fractions[0].smallest_aspect_ratio = random(0.5, 0.7);
    r.fractions[0].largest_aspect_ratio = 0.9;
  }
  Material& m = r.materials[0];
  d.friction = m.friction = kind == 0 ? random(0.05, 0.09) : random(0.3, 0.5);
  d.kappa = kind == 2 ? random.power(3.7, 4) : random.power(2.9, 3.5);
  r.contact.law = kind == 1 ? Law::hertz_mindlin : Law::linear_stiffness;
  m.normal_stiffness = d.kappa * pressure * (dimension == 2 ? thickness : 2 * mean_radius);
  m.tangential_stiffness = random(0.5, 0.9) * m.normal_stiffness;
  m.poisson_ratio = 0.2;
  m.young_modulus = pressure * d.kappa * std::sqrt(d.kappa);
  r.contact.rolling = kind == 4;
  m.rolling_stiffness = random(0.5, 1.5);
  m.rolling_friction = random(0.1, 0.3);
  r.damping.local = 0.1;
  r.solver.max_overlap_ratio = 1;
  r.stress_tolerance = 2e-3;
  r.unbalanced = 1e-4;
  r.stress = pack::isotropic_stress(pressure, r.shape);
  if (kind == 1) r.preparation.friction = 0.1;
  d.ratio = 1 / d.ratio;
  return d;
}

/// Seeds from here on: packings whose grains are cemented or moist, of five kinds (seed % 5).
constexpr std::uint64_t first_with_interactions = 201;
constexpr const char* interacting_kinds[] = {"cemented discs", "cemented spheres", "moist discs, suction",
                                             "moist spheres, suction", "moist spheres, volume"};
constexpr const char* cemented_states[] = {"before breaking", "at the peak", "after the peak"};
constexpr const char* moist_states[] = {"at rest", "after 2 %", "flooded"};
inline bool is_cemented(std::uint64_t seed) { return seed % 5 < 2; }

inline Drawn drawn_interacting(std::uint64_t seed) {
  Random random(seed, 0);
  Drawn d;
  pack::Recipe& r = d.recipe;
  const auto kind = seed % 5;
  r.shape = kind == 0 || kind == 2 ? Shape::disc : Shape::sphere;
  r.seed = seed;
  r.number = std::size_t(random(90, 150));
  r.thickness = thickness;
  d.ratio = random(0.4, 0.7);
  Grading& grading = r.fractions[0].grading;
  grading.smallest_radius = 2 * mean_radius / (1 + 1 / d.ratio);
  grading.largest_radius = grading.smallest_radius / d.ratio;
  Material& m = r.materials[0];
  d.friction = m.friction = random(0.3, 0.6);
  d.kappa = random.power(2.7, 3.5);
  const bool hertz = random.chance(0.4);
  r.contact.law = hertz ? Law::hertz_mindlin : Law::linear_stiffness;
  m.normal_stiffness = d.kappa * pressure * (r.shape == Shape::disc ? thickness : 2 * mean_radius);
  m.tangential_stiffness = random(0.5, 0.9) * m.normal_stiffness;
  m.poisson_ratio = 0.2;
  m.young_modulus = pressure * d.kappa * std::sqrt(d.kappa);
  r.damping.local = 0.1;
  r.solver.max_overlap_ratio = 1;
  r.stress_tolerance = 2e-3;
  r.unbalanced = 1e-4;
  r.stress = pack::isotropic_stress(pressure, r.shape);
  if (random.chance(0.5)) r.preparation.friction = 0.1;
  d.ratio = 1 / d.ratio;
  return d;
}

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

inline Drawn drawn(std::uint64_t seed) {
  return seed < first_of_kinds            ? drawn_recipe(seed)
         : seed < first_with_interactions ? drawn_kind(seed)
                                          : drawn_interacting(seed);
}

inline std::string in_words(std::uint64_t seed) {
  const Drawn d = drawn(seed);
  char text[200];
  std::snprintf(text, sizeof text, "%zu %s%s%s, 1:%.2g, mu %.2g, kappa %.1e", d.recipe.number,
                d.recipe.shape == Shape::disc     ? "discs"
                : d.recipe.shape == Shape::sphere ? "spheres"
                                                  : "ellipses",
                d.recipe.contact.law == Law::hertz_mindlin ? ", Hertz" : "",
                d.recipe.contact.rolling ? ", rolling" : "", d.ratio, d.friction, d.kappa);
  return text;
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
  if (seed >= first_with_interactions) return interacting_states(seed);
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
