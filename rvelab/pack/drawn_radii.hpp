// Sizes of the grains of a fraction, as its recipe draws them.
#pragma once

#include "rvelab/pack/recipe.hpp"

namespace rvelab::pack {

/// Radii, m, in random order, of the numbers[f] grains of fraction f. `curves`: gradings of all fractions by number.
/// Stratified, of a recipe whose shares are by mass, the fraction has exactly its share of the mass. InputError that
/// says how many grains it takes where stratified sampling is off by more than sampling_tolerance.
std::vector<double> drawn_radii(const Recipe& recipe, std::size_t f, const std::vector<NumberCurve>& curves,
                                const std::vector<std::size_t>& numbers, Uniform& uniform);

}  // namespace rvelab::pack
