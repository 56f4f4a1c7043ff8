// A recipe as data: what `rvelab pack` makes, read from a TOML file and checked whole before anything is made.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rvelab/keys/key.hpp"
#include "rvelab/pack/recipe.hpp"

namespace rvelab::pack {

/// A checked recipe file.
struct RecipeFile {
  std::string name;                 ///< [pack] name
  Recipe recipe;                    ///< with the first stress of a family
  bool ellipsoids = false;          ///< pack.shape = "ellipsoid": exponents are 2 without a word
  std::vector<double> pressures;    ///< Pa, of a family; else empty
  std::vector<std::string> doubts;  ///< values that are likely in another unit, one line each
  std::string resolved;             ///< the recipe with every default and assignment in it, TOML; doubts as comments

  /// The recipe of one specimen: with a seed of its own and, of a family, its mean pressure (Pa; all stresses are
  /// scaled).
  RecipeFile member(std::uint64_t seed, std::optional<double> pressure = std::nullopt) const;
};

/// Reads a recipe after the assignments "key=value" have been applied to it. InputError with every mistake, each with
/// its line.
RecipeFile read_recipe(const std::string& path, const std::vector<std::string>& assignments = {});

/// The same from a text; `path` serves messages only.
RecipeFile parse_recipe(const std::string& text, const std::string& path,
                        const std::vector<std::string>& assignments = {});

/// The keys of a recipe, beside which those of contact, damping, solver and material stand.
std::vector<keys::Key> recipe_keys();

/// Whether a TOML file is a recipe, and not a protocol: it has [pack].
bool is_recipe(const std::string& path);

}  // namespace rvelab::pack
