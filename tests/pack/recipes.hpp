// Small recipes whose draws take tenths of a second, and what specimens of bodies packed by them are.
#pragma once

#include <cmath>
#include <string>

#include "rvelab/measure/measures.hpp"
#include "rvelab/pack/draw.hpp"
#include "rvelab/pack/recipe.hpp"
#include "rvelab/pack/repeated.hpp"
#include "rvelab/solver/rve.hpp"
#include "tests/catch.hpp"

namespace rvelab::test {

/// Discs with the linear law at 100 kPa.
inline pack::Recipe discs(std::size_t number = 150) {
  pack::Recipe recipe;
  recipe.number = number;
  recipe.materials[0].young_modulus = 8e8;
  recipe.materials[0].stiffness_ratio = 0.5;
  recipe.materials[0].friction = 0.4;
  recipe.stress = pack::isotropic_stress(1e5, Shape::disc);
  return recipe;
}

/// Ellipses of aspect 0.743 (Liang et al. 2023), laid at 30 degrees and 20 to either side.
inline pack::Recipe ellipses(std::size_t number = 150) {
  pack::Recipe recipe = discs(number);
  recipe.shape = Shape::ellipse;
  recipe.fractions[0].smallest_aspect_ratio = recipe.fractions[0].largest_aspect_ratio = 0.743;
  recipe.fractions[0].bedding_angle = 30;
  recipe.fractions[0].bedding_spread = 20;
  return recipe;
}

/// Spheres with Hertz-Mindlin contacts at 100 kPa.
inline pack::Recipe spheres(std::size_t number = 120) {
  pack::Recipe recipe;
  recipe.shape = Shape::sphere;
  recipe.number = number;
  recipe.fractions[0].grading.smallest_radius = 1e-3;
  recipe.fractions[0].grading.largest_radius = 2e-3;
  recipe.contact.law = Law::hertz_mindlin;
  recipe.materials[0].young_modulus = 7e9;
  recipe.materials[0].poisson_ratio = 0.25;
  recipe.materials[0].friction = 0.5;
  recipe.stress = pack::isotropic_stress(1e5, Shape::sphere);
  return recipe;
}

/// The text of a recipe; `pack` and `grains`: lines of these tables.
inline std::string recipe_text(const std::string& pack, const std::string& grains) {
  return "[pack]\n" + pack + "[grains]\n" + grains + R"(smallest_radius_m = 1e-3
largest_radius_m = 2e-3
[target]
pressure_Pa = 1e5
[[material]]
name = "m"
density_kg_m3 = 2650
young_modulus_Pa = 1e8
stiffness_ratio = 0.5
friction = 0.5
[contact]
law = "linear"
)";
}

/// Bodies packed to 100 kPa at rest, of the radii of their grading; drawn again they have the same bits, and
/// eight (four) of the cell are that cell.
inline pack::Draw check_packed(const pack::Recipe& recipe) {
  const int d = dimension_of(recipe.shape);
  const pack::Draw made = pack::draw(recipe, 1, 0.1, nullptr);
  REQUIRE(made.at_rest);
  const Rve rve(made.specimen);
  const Network network = rve.network();
  CHECK(std::abs(mean_pressure(rve.stress(), d) - 1e5) < 100);
  CHECK(rve.unbalanced_ratio() < 1e-5);
  CHECK(network.grains.size() == recipe.number);
  CHECK(std::abs(void_ratio(network) - made.void_ratio) < 1e-12);
  CHECK(coordination_number(network) > d + 1);  // frictional grains
  for (const GrainState& grain : network.grains) {
    CHECK(grain.radius > recipe.fractions[0].grading.smallest_radius * (1 - 1e-9));
    CHECK(grain.radius < recipe.fractions[0].grading.largest_radius * (1 + 1e-9));
  }
  CHECK(Rve(pack::draw(recipe, 1, 0.1, nullptr).specimen).save() == rve.save());
  const Rve many(pack::repeated(made.specimen, {2, 2, d == 2 ? 1 : 2}));
  CHECK((many.stress() - rve.stress()).norm() < 1e-9 * 1e5);
  CHECK(std::abs(void_ratio(many.network()) - made.void_ratio) < 1e-9);
  return made;
}

}  // namespace rvelab::test
