#include "rvelab/cli/grading_sizes.hpp"

#include <iterator>
#include <string>
#include <vector>

#include "rvelab/pack/largest_grain.hpp"
#include "rvelab/pack/mass_curve.hpp"
#include "rvelab/pack/recipe_grading.hpp"

namespace rvelab::cli {
namespace {

constexpr const char* names_of_parts[] = {"d10_m", "d50_m", "d90_m"};

}  // namespace

Json asked_sizes(const pack::Recipe& recipe) {
  Json sizes;
  const std::vector<double> asked = pack::asked_diameters(recipe);
  for (std::size_t k = 0; k < asked.size(); ++k) sizes[std::string("asked_") + names_of_parts[k]] = asked[k];
  for (const pack::GrainFraction& fraction : recipe.fractions) {
    const pack::ScalpedMass cut = pack::scalped_mass(fraction, dimension_of(recipe.shape));
    const std::string of = recipe.fractions.size() > 1 ? "_" + fraction.name : "";
    if (cut.below > 0) sizes["scalped_below_percent" + of] = 100 * cut.below;
    if (cut.above > 0) sizes["scalped_above_percent" + of] = 100 * cut.above;
  }
  return sizes;
}

Json drawn_sizes(const Specimen& specimen) {
  Json sizes;
  const std::vector<double> parts(std::begin(pack::compared_parts), std::end(pack::compared_parts));
  const std::vector<double> radii = pack::radii_passing(pack::radii_and_masses(specimen), parts);
  for (std::size_t k = 0; k < radii.size(); ++k) sizes[names_of_parts[k]] = 2 * radii[k];
  const pack::LargestGrain largest = pack::largest_grain(specimen);
  sizes["largest_grain_mass_share"] = largest.mass_share;
  sizes["cell_over_largest_diameter"] = largest.cell_widths;
  return sizes;
}

std::string unit_of_size(const std::string& key) { return key.ends_with("_m") ? "m" : ""; }

void warn_of_largest_grain(const std::string& file, const Specimen& specimen) {
  static bool reported = false;
  if (reported) return;
  const std::string unusual = pack::unusual_in_words(pack::largest_grain(specimen), "of these sizes");
  if (unusual.empty()) return;
  reported = true;
  tell("warning: " + file + ": " + unusual);
}

}  // namespace rvelab::cli
