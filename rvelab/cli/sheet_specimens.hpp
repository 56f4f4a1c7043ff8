// The specimens of `rvelab sheet`: packed from a recipe, one a density and seed, or given as files.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rvelab/pack/read_recipe.hpp"
#include "rvelab/sheet/plan.hpp"

namespace rvelab::cli {

/// Of one kind: a density of the plan, or given files whose names differ by their last number ("dense_1.h5").
struct SpecimenGroup {
  std::string name;
  double relative_density = sheet::unknown;
};

struct SheetSpecimen {
  std::string file;
  std::size_t group = 0;   ///< of SheetSpecimens::groups
  std::size_t number = 0;  ///< within the group, from 0
  std::uint64_t seed = 0;
  pack::RecipeFile recipe;  ///< it is packed from; of a given one empty
};

struct SheetSpecimens {
  std::vector<SpecimenGroup> groups;
  std::vector<SheetSpecimen> all;  ///< first ones of all groups, then second ones ...
  std::string soil;                ///< name of the recipe, or of the first file
  int dimension = 3;
  bool given = false;
  std::vector<std::string> remarks;  ///< what is unknown of given ones
};

/// Those of a recipe, to be packed into `folder`; `settings` of the recipe over those of the plan.
SheetSpecimens specimens_of_recipe(const sheet::Plan& plan, const std::string& recipe,
                                   const std::vector<std::string>& settings, const std::string& folder);
/// Given files. InputError: one that cannot be read, of another dimension, or the same as another.
SheetSpecimens specimens_of_files(const sheet::Plan& plan, const std::vector<std::string>& files);

/// Packs those that are not there yet, `threads` at a time; with `share` other processes pack too, and this one waits
/// for theirs. Returns why specimens could not be packed, "" for the others. Ends by end_stopped after a signal.
std::vector<std::string> pack_specimens(const SheetSpecimens& specimens, unsigned threads, bool share);

}  // namespace rvelab::cli
