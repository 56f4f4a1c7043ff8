// Diameters by mass as commands print them: those that a recipe asks for, and those of the grains.
#pragma once

#include "rvelab/cli/report.hpp"
#include "rvelab/pack/recipe.hpp"

namespace rvelab::cli {

/// asked_d10_m, asked_d50_m, asked_d90_m; of each fraction that is scalped, what is cut off, in percent of its mass.
Json asked_sizes(const pack::Recipe& recipe);

/// d10_m, d50_m, d90_m of the grains, and the largest of them beside the mass and the cell.
Json drawn_sizes(const Specimen& specimen);

/// "m" of keys that end in it, else "".
std::string unit_of_size(const std::string& key);

/// Warns, once, of a specimen whose largest grain is too large for its mass or cell.
void warn_of_largest_grain(const std::string& file, const Specimen& specimen);

}  // namespace rvelab::cli
