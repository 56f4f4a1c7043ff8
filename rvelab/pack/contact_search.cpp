#include "rvelab/pack/contact_search.hpp"

#include <algorithm>
#include <cmath>

#include "rvelab/error.hpp"
#include "rvelab/measure/measures.hpp"

namespace rvelab::pack {

namespace {

/// d Z_mech / d ln expansion, and d (anisotropy) / d (difference of strains), of 400 discs and 500 spheres.
double contacts_by_expansion(int dimension) { return dimension == 2 ? -0.2 : -0.8; }
double anisotropy_by_difference(int dimension) { return dimension == 2 ? 0.1 : 0.4; }
/// Compressions for one target, and for both: of 500 grains one in two or three has each within its tolerance.
constexpr std::size_t most_compressions = 8, most_compressions_of_both = 16;
/// The void ratio rises by this where a contact a grain is lost by a wider expansion (500 spheres: 0.006 above five
/// contacts, 0.02 below); its scatter from one compression to the next. A draw that will miss the void ratio of the
/// target by more than both is given up, whatever its contacts.
constexpr double void_ratio_by_contacts = 0.008, scatter_of_void_ratio = 1e-3;

std::string range_of(const std::vector<Compressed>& made, double Compressed::*value) {
  const auto [least, most] = std::minmax_element(
      made.begin(), made.end(), [&](const Compressed& a, const Compressed& b) { return a.*value < b.*value; });
  return in_words((*least).*value) + " to " + in_words((*most).*value);
}

}  // namespace

bool Compressed::meets(const ContactTarget& target) const {
  const auto within = [](double value, const std::optional<double>& wanted, double tolerance) {
    return !wanted || std::abs(value - *wanted) <= tolerance;
  };
  return within(coordination_number, target.coordination_number, target.coordination_tolerance) &&
         within(fabric_anisotropy, target.fabric_anisotropy, target.fabric_tolerance);
}

double Compressed::void_ratio_at(const ContactTarget& target) const {
  return void_ratio +
         void_ratio_by_contacts * (coordination_number - target.coordination_number.value_or(coordination_number));
}

Compressed compressed_state(const Recipe& recipe, const Agitation& by, const Network& network) {
  return {by, void_ratio(network), mechanical_coordination_number(network),
          anisotropy_along(fabric(network), network.dimension(), fabric_axis(recipe))};
}

ContactSearch::ContactSearch(const Recipe& recipe, const Agitation& first)
    : recipe_(recipe),
      expansion_(std::log(smallest_expansion), std::log(largest_expansion), std::log(first.expansion),
                 contacts_by_expansion(dimension_of(recipe.shape)), recipe.contacts.coordination_tolerance),
      difference_(-largest_strain_difference, largest_strain_difference, first.strain_difference,
                  anisotropy_by_difference(dimension_of(recipe.shape)), recipe.contacts.fabric_tolerance) {}

Agitation ContactSearch::next() const {
  const Preparation& p = recipe_.preparation;
  return {p.expansion ? *p.expansion : std::exp(expansion_.next()),
          recipe_.contacts.fabric_anisotropy ? difference_.next() : p.strain_difference.value_or(0)};
}

void ContactSearch::add(const Compressed& made) {
  made_.push_back(made);
  const ContactTarget& target = recipe_.contacts;
  if (target.coordination_number)
    expansion_.add(std::log(made.by.expansion), made.coordination_number - *target.coordination_number);
  if (target.fabric_anisotropy)
    difference_.add(made.by.strain_difference, made.fabric_anisotropy - *target.fabric_anisotropy);
}

bool ContactSearch::met() const { return !made_.empty() && made_.back().meets(recipe_.contacts); }

bool ContactSearch::density_is_missed() const {
  if (made_.empty() || !recipe_.void_ratio) return false;
  const Compressed& last = made_.back();
  const double wanted = recipe_.contacts.coordination_number.value_or(last.coordination_number);
  return std::abs(last.void_ratio_at(recipe_.contacts) - *recipe_.void_ratio) >
         recipe_.void_ratio_tolerance + scatter_of_void_ratio +
             void_ratio_by_contacts * std::abs(last.coordination_number - wanted);
}

bool ContactSearch::in_vain() const {
  if (made_.empty() || met()) return false;
  const bool both = recipe_.contacts.coordination_number && recipe_.contacts.fabric_anisotropy;
  return made_.size() >= (both ? most_compressions_of_both : most_compressions) || expansion_.out_of_range() ||
         difference_.out_of_range();
}

std::string reached_in_words(const std::vector<Compressed>& made) {
  return "coordination numbers of " + range_of(made, &Compressed::coordination_number) + " at void ratios of " +
         range_of(made, &Compressed::void_ratio);
}

std::string fabric_in_words(const std::vector<Compressed>& made) {
  return "anisotropies of " + range_of(made, &Compressed::fabric_anisotropy);
}

}  // namespace rvelab::pack
