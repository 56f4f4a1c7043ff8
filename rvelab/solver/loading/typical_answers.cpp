#include "rvelab/solver/loading/typical_answers.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "rvelab/solver/assembly/contact_states.hpp"

namespace rvelab {

namespace {

/// Normal stiffnesses that count as alike, over each other.
constexpr double most_unlike = 10;

std::size_t largest_grain(const Model& model) {
  return std::size_t(std::max_element(model.radius.begin(), model.radius.end()) - model.radius.begin());
}

/// Two grains of the size of grain g and of one material as a pair.
PairParameters pair_of(const Model& model, std::size_t g, const Material& m) {
  const double section = grain_section(model.shape, model.radius[g], model.thickness);
  return mix(model.contact, model.damping, m, model.radius[g], model.mass[g], m, model.radius[g], model.mass[g],
             section);
}

/// Two of the largest grains as a pair, and their radius.
std::pair<PairParameters, double> typical_pair(const Model& model) {
  const std::size_t g = largest_grain(model);
  return {pair_of(model, g, model.materials[model.material[g]]), model.radius[g]};
}

ContactStiffness stiffness_of(const Model& model, const PairParameters& q, double overlap) {
  return with_force(model, [&](auto force) { return rvelab::stiffness_of<decltype(force)>(model, q, overlap); });
}

}  // namespace

double typical_normal_force(const Model& model, double overlap) {
  return with_force(model, [&](auto force) {
    return std::abs(normal_force_of<decltype(force)>(typical_pair(model).first, overlap));
  });
}

TypicalContact typical_contact(const Model& model) {
  const auto [one, radius] = typical_pair(model);
  return {stiffness_of(model, one, 1e-3 * radius), radius};
}

void set_typical_answers(Model& model) {
  model.slip_frequency_ratio = model.rolling_constraint_factor = 1;
  const PairParameters one = typical_pair(model).first;
  const ContactStiffness k = typical_contact(model).stiffness;
  const double radius = typical_contact(model).radius;
  const double overlap = 1e-3 * radius;
  model.alike_contacts = std::all_of(model.materials.begin(), model.materials.end(), [&](const Material& m) {
    const double other = stiffness_of(model, pair_of(model, largest_grain(model), m), overlap).normal;
    return std::max(other, k.normal) <= most_unlike * std::min(other, k.normal);
  });
  const double force = typical_normal_force(model, overlap);
  model.hardening = force > 0 ? std::clamp(k.normal * overlap / force, 1.0, 3.0) : 1;
  if (!model.contact.rolling) return;
  const int d = model.dimension();
  const double grip = grip_of(one.friction), rolling_grip = grip_of(one.moment_cap / radius);
  model.rolling_constraint_factor = (1 + (d - 1) * (grip + rolling_grip)) / (1 + 2 * (d - 1) * grip);
  const double slip = 4 * k.tangential * radius * radius;
  if (slip > 0) model.slip_frequency_ratio = std::sqrt(slip / (slip + 2 * k.rolling));
}

}  // namespace rvelab
