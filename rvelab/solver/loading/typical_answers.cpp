#include "rvelab/solver/loading/typical_answers.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "rvelab/solver/assembly/contact_states.hpp"

namespace rvelab {

namespace {

/// Normal stiffnesses that count as alike, over each other.
constexpr double most_unlike = 10;

std::size_t largest_grain(const Model& f) {
  return std::size_t(std::max_element(f.radius.begin(), f.radius.end()) - f.radius.begin());
}

/// Two grains of the size of grain g and of one material as a pair.
PairParameters pair_of(const Model& f, std::size_t g, const Material& m) {
  const double section = grain_section(f.shape, f.radius[g], f.thickness);
  return mix(f.contact, f.damping, m, f.radius[g], f.mass[g], m, f.radius[g], f.mass[g], section);
}

/// Two of the largest grains as a pair, and their radius.
std::pair<PairParameters, double> typical_pair(const Model& f) {
  const std::size_t g = largest_grain(f);
  return {pair_of(f, g, f.materials[f.material[g]]), f.radius[g]};
}

ContactStiffness stiffness_of(const Model& f, const PairParameters& q, double overlap) {
  return with_force(f, [&](auto force) { return rvelab::stiffness_of<decltype(force)>(f, q, overlap); });
}

}  // namespace

double typical_normal_force(const Model& f, double overlap) {
  return with_force(
      f, [&](auto force) { return std::abs(normal_force_of<decltype(force)>(typical_pair(f).first, overlap)); });
}

TypicalContact typical_contact(const Model& f) {
  const auto [one, radius] = typical_pair(f);
  return {stiffness_of(f, one, 1e-3 * radius), radius};
}

void set_typical_answers(Model& f) {
  f.slip_frequency_ratio = f.rolling_constraint_factor = 1;
  const PairParameters one = typical_pair(f).first;
  const auto [k, radius] = typical_contact(f);
  const double overlap = 1e-3 * radius;
  f.alike_contacts = std::all_of(f.materials.begin(), f.materials.end(), [&](const Material& m) {
    const double other = stiffness_of(f, pair_of(f, largest_grain(f), m), overlap).normal;
    return std::max(other, k.normal) <= most_unlike * std::min(other, k.normal);
  });
  const double force = typical_normal_force(f, overlap);
  f.hardening = force > 0 ? std::clamp(k.normal * overlap / force, 1.0, 3.0) : 1;
  if (!f.contact.rolling) return;
  const int d = f.dimension();
  const double grip = grip_of(one.friction), rolling_grip = grip_of(one.moment_cap / radius);
  f.rolling_constraint_factor = (1 + (d - 1) * (grip + rolling_grip)) / (1 + 2 * (d - 1) * grip);
  const double slip = 4 * k.tangential * radius * radius;
  if (slip > 0) f.slip_frequency_ratio = std::sqrt(slip / (slip + 2 * k.rolling));
}

}  // namespace rvelab
