// Recipes of the packings of rvelab-estimates, drawn by seed.
#pragma once

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "rvelab/grains/uniform.hpp"
#include "rvelab/pack/recipe.hpp"

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

/// What all recipes here have in common.
inline void set_loading(pack::Recipe& r) {
  r.damping.local = 0.1;
  r.solver.max_overlap_ratio = 1;
  r.stress_tolerance = 2e-3;
  r.unbalanced = 1e-4;
  r.stress = pack::isotropic_stress(pressure, r.shape);
}

/// Whose middle is mean_radius. `ratio`: smallest over largest.
inline void set_radii(Grading& grading, double ratio) {
  grading.smallest_radius = 2 * mean_radius / (1 + 1 / ratio);
  grading.largest_radius = grading.smallest_radius / ratio;
}

inline void set_aspects(pack::GrainFraction& ellipses, Random& random) {
  ellipses.smallest_aspect_ratio = random(0.5, 0.7);
  ellipses.largest_aspect_ratio = 0.9;
}

/// Of both laws, by kappa; kt/kn of 0.5 to 0.9.
inline void set_stiffness(Drawn& d, Random& random) {
  Material& m = d.recipe.materials[0];
  const bool plane = dimension_of(d.recipe.shape) == 2;
  m.normal_stiffness = d.kappa * pressure * (plane ? thickness : 2 * mean_radius);
  m.tangential_stiffness = random(0.5, 0.9) * m.normal_stiffness;
  m.poisson_ratio = 0.2;
  m.young_modulus = pressure * d.kappa * std::sqrt(d.kappa);
}

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
  set_loading(r);
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
  r.seed = seed;
  r.number = std::size_t(kind == 0 ? 400 : kind == 4 ? random(150, 250) : random(120, 180));
  r.thickness = thickness;
  d.ratio = kind == 1 ? 0.25 : random(0.4, 0.6);
  Grading& grading = r.fractions[0].grading;
  grading.curve = kind == 1 ? GradingCurve::linear : GradingCurve::uniform;
  set_radii(grading, d.ratio);
  if (kind == 3) {
    set_aspects(r.fractions[0], random);
  }
  Material& m = r.materials[0];
  d.friction = m.friction = kind == 0 ? random(0.05, 0.09) : random(0.3, 0.5);
  d.kappa = kind == 2 ? random.power(3.7, 4) : random.power(2.9, 3.5);
  r.contact.law = kind == 1 ? Law::hertz_mindlin : Law::linear_stiffness;
  set_stiffness(d, random);
  r.contact.rolling = kind == 4;
  m.rolling_stiffness = random(0.5, 1.5);
  m.rolling_friction = random(0.1, 0.3);
  set_loading(r);
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
  set_radii(grading, d.ratio);
  Material& m = r.materials[0];
  d.friction = m.friction = random(0.3, 0.6);
  d.kappa = random.power(2.7, 3.5);
  const bool hertz = random.chance(0.4);
  r.contact.law = hertz ? Law::hertz_mindlin : Law::linear_stiffness;
  set_stiffness(d, random);
  set_loading(r);
  if (random.chance(0.5)) r.preparation.friction = 0.1;
  d.ratio = 1 / d.ratio;
  return d;
}

/// Seeds from here on: bodies, of five kinds (seed % 5).
constexpr std::uint64_t first_of_shapes = 321;
constexpr const char* shape_kinds[] = {"clumps of discs", "clumps of spheres", "ellipsoids", "superellipsoids",
                                       "mixtures"};

/// 50 to 90 bodies of friction 0.2 to 0.6. Clumps: a shape of the library; ellipsoids: aspect ratios of 1 to 2.5;
/// superellipsoids: exponents of 2 to 5 besides; mixtures: half spheres or discs (clumps of one), half another clump.
inline Drawn drawn_shape(std::uint64_t seed, std::uint64_t kind) {
  Random random(seed, 0);
  Drawn d;
  pack::Recipe& r = d.recipe;
  r.clumps = kind < 2 || kind == 4;
  const bool plane = kind == 0 || (kind == 4 && random.chance(0.5));
  r.shape = plane ? Shape::disc : r.clumps ? Shape::sphere : Shape::superellipsoid;
  r.seed = seed;
  r.number = std::size_t(random(50, 90));
  r.thickness = thickness;
  d.ratio = random(0.4, 0.8);
  Grading& grading = r.fractions[0].grading;
  set_radii(grading, d.ratio);
  if (r.clumps) {
    std::vector<Clump> library;
    const int dimension = dimension_of(r.shape);
    for (const PublishedClump& p : published_clumps())
      if (plane ? p.plane : p.space) library.push_back(published_clump(p.name, dimension));
    r.fractions[0].clump = library[std::size_t(random(0, double(library.size())))];
    if (kind == 4) {
      r.fractions.push_back(r.fractions[0]);
      r.fractions[0].share = r.fractions[1].share = 0.5;
      r.fractions[0].name = "round";
      r.fractions[0].clump = clump_of("round", {{Eigen::Vector3d::Zero(), 1}}, dimension);
    }
  } else {
    r.fractions[0].half_axes = {random(1, 2.5), random(1, 1.5), 1};
    if (kind == 3) {
      r.fractions[0].exponent_xy = random(2, 5);
      r.fractions[0].exponent_z = random(2, 5);
    }
  }
  Material& m = r.materials[0];
  d.friction = m.friction = random(0.2, 0.6);
  d.kappa = random.power(2.7, 3.7);
  const bool hertz = r.clumps && random.chance(0.4);
  r.contact.law = hertz ? Law::hertz_mindlin : Law::linear_stiffness;
  set_stiffness(d, random);
  set_loading(r);
  if (random.chance(0.5)) r.preparation.friction = 0.1;
  d.ratio = 1 / d.ratio;
  return d;
}

/// Seeds from here on: of seven kinds (seed % 7) that an outside check drew. Increments of 1e-6 to 1e-2, and all errors
/// count, those of chaotic increments too: a user has one calculation, and asks how far it is from a slow one.
constexpr std::uint64_t first_of_all_errors = 501;
constexpr const char* drawn_kinds[] = {"loose discs",   "radii 1:4", "overlaps of 1e-4", "ellipses",
                                       "friction 0.07", "clumps",    "ellipsoids"};

inline Drawn drawn_for_all_errors(std::uint64_t seed) {
  const auto kind = seed % 7;
  if (kind >= 5) return drawn_shape(seed, kind == 6 ? 2 : seed % 2);
  Random random(seed, 0);
  Drawn d;
  pack::Recipe& r = d.recipe;
  r.shape = kind == 3 ? Shape::ellipse : kind == 2 || (kind == 1 && random.chance(0.5)) ? Shape::sphere : Shape::disc;
  const bool plane = dimension_of(r.shape) == 2;
  r.seed = seed;
  r.number = std::size_t(plane ? random(150, 400) : random(120, 250));
  r.thickness = thickness;
  d.ratio = kind == 1 ? 0.25 : random(0.4, 0.7);
  set_radii(r.fractions[0].grading, d.ratio);
  if (kind == 3) {
    set_aspects(r.fractions[0], random);
  }
  Material& m = r.materials[0];
  d.friction = m.friction = kind == 4 ? random(0.06, 0.08) : random(0.3, 0.6);
  d.kappa = kind == 2 ? random.power(3.9, 4) : random.power(2.7, 3.7);
  r.contact.law = kind == 1 && random.chance(0.5) ? Law::hertz_mindlin : Law::linear_stiffness;
  set_stiffness(d, random);
  set_loading(r);
  if (kind != 0 && random.chance(0.5)) r.preparation.friction = std::min(m.friction, 0.1);
  d.ratio = 1 / d.ratio;
  return d;
}

inline bool is_interacting(std::uint64_t seed) { return seed >= first_with_interactions && seed < first_of_shapes; }

inline Drawn drawn(std::uint64_t seed) {
  return seed < first_of_kinds            ? drawn_recipe(seed)
         : seed < first_with_interactions ? drawn_kind(seed)
         : seed < first_of_shapes         ? drawn_interacting(seed)
         : seed < first_of_all_errors     ? drawn_shape(seed, seed % 5)
                                          : drawn_for_all_errors(seed);
}

inline std::string in_words(std::uint64_t seed) {
  const Drawn d = drawn(seed);
  const pack::Recipe& r = d.recipe;
  std::string grains = r.shape == Shape::superellipsoid ? "superellipsoids"
                       : r.shape == Shape::disc         ? "discs"
                       : r.shape == Shape::sphere       ? "spheres"
                                                        : "ellipses";
  if (r.clumps) grains = r.fractions.back().clump->name + " of " + grains;
  char text[200];
  std::snprintf(text, sizeof text, "%zu %s%s%s, 1:%.2g, mu %.2g, kappa %.1e", r.number, grains.c_str(),
                r.contact.law == Law::hertz_mindlin ? ", Hertz" : "", r.contact.rolling ? ", rolling" : "", d.ratio,
                d.friction, d.kappa);
  return text;
}

}  // namespace rvelab::estimates
