// The tables [target] and [preparation] of a recipe.
#pragma once

#include "rvelab/keys/table_reader.hpp"
#include "rvelab/pack/read_recipe.hpp"

namespace rvelab::pack {

/// Stress, density, number of contacts and fabric of the finished specimen.
void read_target(keys::TableReader& reader, RecipeFile& file);
/// How the grains are brought there; after read_target.
void read_preparation(keys::TableReader& reader, RecipeFile& file);

}  // namespace rvelab::pack
