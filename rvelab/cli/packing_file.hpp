// A packed specimen as a file, with how it came about.
#pragma once

#include <string>

#include "rvelab/pack/read_recipe.hpp"
#include "rvelab/pack/recipe.hpp"

namespace rvelab::cli {

/// Writes a packing that `recipe` gave: throws as io::write_specimen does.
void write_packing(const pack::Packing& packing, const pack::RecipeFile& recipe, const std::string& path);

}  // namespace rvelab::cli
