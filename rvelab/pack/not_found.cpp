#include "rvelab/pack/not_found.hpp"

#include <algorithm>

namespace rvelab::pack {

double near_density(const Recipe& recipe) { return std::max(5 * recipe.void_ratio_tolerance, 0.01); }

namespace {

/// The trials of agitated grains, those near the void ratio of the target if there are any.
std::vector<Compressed> compressed_of(const Recipe& recipe, const std::vector<Draw>& draws) {
  std::vector<Compressed> all, near;
  for (const Draw& draw : draws)
    for (const Compressed& each : draw.compressed) {
      all.push_back(each);
      if (recipe.void_ratio && std::abs(each.void_ratio - *recipe.void_ratio) <= near_density(recipe))
        near.push_back(each);
    }
  return near.empty() ? all : near;
}

/// The numbers of contacts that agitated grains reached, and what to do about a target that is out of it.
Error contacts_not_found(const Recipe& recipe, const std::vector<Draw>& draws) {
  const ContactTarget& target = recipe.contacts;
  const std::vector<Compressed> made = compressed_of(recipe, draws);
  TextStream text;
  if (target.coordination_number) {
    text << "target.coordination_number = " << *target.coordination_number << " within "
         << target.coordination_tolerance;
    if (target.fabric_anisotropy) text << ", with ";
  }
  if (target.fabric_anisotropy)
    text << "target.fabric_anisotropy = " << *target.fabric_anisotropy << " within " << target.fabric_tolerance;
  text << " was not met in " << made.size() << " compressions; reached: " << reached_in_words(made);
  if (target.fabric_anisotropy) text << " with " << fabric_in_words(made);
  text << "; give a target between these, more contacts by a lower void ratio or a lower friction of the material, "
          "fewer by a higher one, or raise the tolerance or pack.number";
  return Error(text.str());
}

}  // namespace

Error not_found(const Recipe& recipe, const std::vector<Draw>& draws, std::size_t failed, End end) {
  if (end == End::contacts_out_of_reach) return contacts_not_found(recipe, draws);
  const auto order = [](const Draw& a, const Draw& b) { return a.void_ratio < b.void_ratio; };
  const auto [lowest, highest] = std::minmax_element(draws.begin(), draws.end(), order);
  TextStream text;
  text << "target.void_ratio = " << *recipe.void_ratio << " was not met within " << recipe.void_ratio_tolerance
       << " in " << draws.size() + failed << " packings"
       << (failed > 0 ? " (" + std::to_string(failed) + " failed)" : "") << "; reached: " << lowest->void_ratio
       << " (preparation friction " << lowest->friction << ") to " << highest->void_ratio << " (" << highest->friction
       << ")";
  if (is_agitated(recipe)) text << ", with " << reached_in_words(compressed_of(recipe, draws));
  text << (end == End::out_of_reach ? ", too far from it for more packings to help; " : "; ");
  if (*recipe.void_ratio > highest->void_ratio) {
    if (recipe.preparation.expansion && recipe.preparation.least_expansion.value_or(1) > 0)
      text << "grains that were agitated by preparation.expansion = " << *recipe.preparation.expansion
           << " become denser: give a smaller one, or preparation.least_expansion; or ";
    text << "give a lower void ratio, a lower pressure, rolling friction in the preparation, or raise "
            "preparation.highest_friction";
  } else if (*recipe.void_ratio < lowest->void_ratio) {
    text << "give a higher void ratio, a higher pressure or a wider grading"
         << (recipe.preparation.lowest_friction > 0 ? ", or lower preparation.lowest_friction" : "");
  } else {
    text << "raise preparation.max_draws, or target.void_ratio_tolerance";
  }
  return Error(text.str());
}

}  // namespace rvelab::pack
