// Small recipes whose draws take tenths of a second.
#pragma once

#include "rvelab/pack/recipe.hpp"

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

}  // namespace rvelab::test
