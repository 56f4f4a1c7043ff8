// The grading that a recipe asks for, before a grain is placed: its diameters by mass, what scalping cuts off, and how
// many grains it takes.
#pragma once

#include <string>
#include <vector>

#include "rvelab/pack/recipe.hpp"

namespace rvelab::pack {

/// d10, d50 and d90 by mass of all fractions together after scalping, m, of discs or spheres of the same area or
/// volume.
std::vector<double> asked_diameters(const Recipe& recipe);

/// Parts of the mass of a fraction that scalping cuts off, in [0, 1].
struct ScalpedMass {
  double below = 0, above = 0;
};
ScalpedMass scalped_mass(const GrainFraction& fraction, int dimension);

/// Whether a grading asks for more grains than the recipe makes: the cell would be thin beside the largest of them, or
/// that one so large a part of the mass that it alone makes the result (largest_grain.hpp). One line, with the number
/// of grains that each rule asks for, and of one fraction the scalping with which these grains are enough; empty where
/// they are. Up to 100,000 grains by those that its seed draws, beyond by the largest of the grading. InputError as
/// graded_grains.
std::vector<std::string> too_few_grains(const Recipe& recipe);

}  // namespace rvelab::pack
