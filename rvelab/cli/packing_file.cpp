#include "rvelab/cli/packing_file.hpp"

#include "rvelab/io/hdf5/specimen_file.hpp"

namespace rvelab::cli {

void write_packing(const pack::Packing& packing, const pack::RecipeFile& recipe, const std::string& path) {
  io::SpecimenOrigin origin{recipe.resolved, recipe.recipe.seed, packing.draw, packing.preparation_friction};
  if (packing.agitation) {
    origin.expansion = packing.agitation->expansion;
    origin.strain_difference = packing.agitation->strain_difference;
  }
  io::write_specimen(packing.specimen, path, &origin);
}

}  // namespace rvelab::cli
