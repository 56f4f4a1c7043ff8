// Measures of a contact network.
#include "rvelab/measure/measures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "rvelab/measure/deviator.hpp"

namespace rvelab {
namespace {

constexpr double not_defined = std::numeric_limits<double>::quiet_NaN();

double solid_volume(const Network& network, const GrainState& grain) {
  return grain_volume(network.shape, grain.radius, network.cell.lattice(2, 2));
}

/// (V - Vs)/Vs over the grains for which `counted` is true.
template <class Counted>
double void_ratio_of(const Network& network, Counted counted) {
  double solid = 0;
  for (std::size_t g = 0; g < network.grains.size(); ++g) {
    if (counted(g)) solid += solid_volume(network, network.grains[g]);
  }
  return solid > 0 ? (network.cell.volume() - solid) / solid : not_defined;
}

/// A mean over the grains, over the force scale of the unbalanced ratio.
template <class OfGrain>
double unbalanced(const Network& network, const OfGrain& of_grain) {
  double left = 0, force = 0;
  for (const GrainState& grain : network.grains) left += of_grain(grain);
  for (const ContactState& contact : network.contacts) force += contact.force().norm();
  for (const ContactState& other : network.interactions) force += other.force().norm();
  if (!network.grains.empty()) left /= network.grains.size();
  force /= double(std::max({std::size_t(1), network.contacts.size(), network.interactions.size()}));
  const double scale = std::max(force, 1e-3 * network.reference_contact_force);
  return scale > 0 ? left / scale : 0.0;
}

}  // namespace

Matrix3 contact_stress(const Network& network) {
  Matrix3 sum = Matrix3::Zero();
  for (const ContactState& contact : network.contacts) sum -= contact.force() * contact.branch.transpose();
  for (const ContactState& other : network.interactions) sum -= other.force() * other.branch.transpose();
  return in_laboratory(network, sum / network.cell.volume());
}

Matrix3 interaction_stress(const Network& network, Family family) {
  Matrix3 sum = Matrix3::Zero();
  for (const InteractionState& other : network.interactions)
    if (family_of(other.kind) == family) sum -= other.force() * other.branch.transpose();
  return in_laboratory(network, sum / network.cell.volume());
}

Matrix3 reynolds_stress(const Network& network) {
  if (network.loading == Loading::quasi_static) return Matrix3::Zero();
  Matrix3 sum = Matrix3::Zero();
  for (const GrainState& grain : network.grains) sum -= grain.mass * grain.velocity * grain.velocity.transpose();
  return in_laboratory(network, sum / network.cell.volume());
}

double deviatoric_stress(const Matrix3& stress, int dimension) {
  return std::sqrt(dimension == 2 ? 0.5 : 1.5) * deviator(stress, dimension).norm();
}

double deviatoric_strain(const Matrix3& strain, int dimension) {
  return std::sqrt(dimension == 2 ? 2.0 : 2.0 / 3.0) * deviator(strain, dimension).norm();
}

Matrix3 fabric(const Network& network) {
  Matrix3 sum = Matrix3::Zero();
  for (const ContactState& contact : network.contacts) sum += contact.normal * contact.normal.transpose();
  return in_laboratory(network, sum / static_cast<double>(network.contacts.size()));
}

Matrix3 branch_fabric(const Network& network) {
  Matrix3 sum = Matrix3::Zero();
  for (const ContactState& contact : network.contacts) sum += contact.branch * contact.branch.transpose();
  return in_laboratory(network, sum / sum.trace());
}

Matrix3 orientation_fabric(const Network& network) {
  Matrix3 sum = Matrix3::Zero();
  if ((is_round(network.shape) && !network.has_bodies()) || network.grains.empty())
    return Matrix3::Constant(not_defined);
  for (const GrainState& grain : network.grains) sum += grain.orientation * grain.orientation.transpose();
  return in_laboratory(network, sum / static_cast<double>(network.grains.size()));
}

double fabric_anisotropy(const Matrix3& fabric, int dimension) {
  const Matrix3 difference = fabric - identity_in(dimension) / dimension;
  return dimension == 2 ? 4 * std::sqrt(0.5) * difference.norm() : 7.5 * std::sqrt(1.5) * difference.norm();
}

std::vector<int> contact_counts(const Network& network) {
  std::vector<int> count(network.grains.size(), 0);
  for (const ContactState& contact : network.contacts) {
    ++count[contact.i];
    ++count[contact.j];
  }
  return count;
}

std::vector<bool> rattlers(const Network& network) {
  std::vector<int> count = contact_counts(network);
  std::vector<bool> removed(network.grains.size(), false);
  // What holds rotations holds its grains by itself.
  const auto count_interactions = [&] {
    for (const InteractionState& other : network.interactions)
      for (const std::int32_t g : {other.i, other.j}) count[std::size_t(g)] += other.rolling_stiffness > 0 ? 2 : 1;
  };
  count_interactions();
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t g = 0; g < count.size(); ++g) {
      if (!removed[g] && count[g] < 2) changed = removed[g] = true;
    }
    std::fill(count.begin(), count.end(), 0);
    count_interactions();
    for (const ContactState& contact : network.contacts) {
      if (removed[contact.i] || removed[contact.j]) continue;
      ++count[contact.i];
      ++count[contact.j];
    }
  }
  return removed;
}

double coordination_number(const Network& network) {
  return network.grains.empty() ? not_defined : 2.0 * network.contacts.size() / network.grains.size();
}

double touching_neighbours(const Network& network) {
  if (!network.has_bodies() || network.has_solids()) return coordination_number(network);
  std::vector<std::tuple<std::int32_t, std::int32_t, Image>> pairs;
  pairs.reserve(network.contacts.size());
  for (const ContactState& c : network.contacts) pairs.emplace_back(c.i, c.j, c.image);
  std::sort(pairs.begin(), pairs.end());
  const auto different = std::unique(pairs.begin(), pairs.end()) - pairs.begin();
  return 2.0 * double(different) / double(network.grains.size());
}

double mechanical_coordination_number(const Network& network) {
  const std::vector<bool> removed = rattlers(network);
  const auto grains = std::count(removed.begin(), removed.end(), false);
  const auto contacts =
      std::count_if(network.contacts.begin(), network.contacts.end(),
                    [&](const ContactState& contact) { return !removed[contact.i] && !removed[contact.j]; });
  return grains > 0 ? 2.0 * contacts / grains : not_defined;
}

double pore_volume(const Network& network) {
  double solid = 0;
  for (const GrainState& grain : network.grains) solid += solid_volume(network, grain);
  return network.cell.volume() - solid;
}

double void_ratio(const Network& network) {
  return void_ratio_of(network, [](std::size_t) { return true; });
}

double mechanical_void_ratio(const Network& network) {
  const std::vector<bool> removed = rattlers(network);
  return void_ratio_of(network, [&](std::size_t g) { return !removed[g]; });
}

double sliding_fraction(const Network& network) {
  if (network.contacts.empty()) return 0;
  const auto sliding = std::count_if(network.contacts.begin(), network.contacts.end(), [](const ContactState& contact) {
    return contact.tangential_force.norm() >= (1 - 1e-6) * contact.friction * std::abs(contact.pressing_force);
  });
  return static_cast<double>(sliding) / network.contacts.size();
}

double unbalanced_force_ratio(const Network& network) {
  return unbalanced(network, [](const GrainState& grain) { return grain.resultant.norm(); });
}

double unbalanced_torque_ratio(const Network& network) {
  return unbalanced(network, [](const GrainState& grain) { return grain.torque.norm() / grain.radius; });
}

double elastic_energy(const Network& network) {
  double sum = 0;
  for (const ContactState& contact : network.contacts) sum += contact.elastic_energy;
  for (const ContactState& other : network.interactions) sum += other.elastic_energy;
  return sum;
}

double kinetic_energy(const Network& network) {
  if (network.loading == Loading::quasi_static) return 0;
  double sum = 0;
  for (std::size_t b = 0; b < network.moments.size(); ++b) {
    const GrainState& body = network.grains[b];
    const Vector3 spin = body.spin + network.mean_spin;
    sum += 0.5 * (body.mass * body.velocity.squaredNorm() + spin.dot(network.moments[b] * spin));
  }
  if (network.has_bodies()) return sum;
  for (const GrainState& grain : network.grains) {
    const Vector3 spin = grain.spin + network.mean_spin;
    sum += 0.5 * (grain.mass * grain.velocity.squaredNorm() + grain.inertia * spin.squaredNorm());
  }
  return sum;
}

double largest_overlap_ratio(const Network& network) {
  double largest = 0;
  for (const ContactState& contact : network.contacts) {
    const auto& round = network.drawn();
    const double smaller = std::min(round[std::size_t(network.has_bodies() ? contact.member_i : contact.i)].radius,
                                    round[std::size_t(network.has_bodies() ? contact.member_j : contact.j)].radius);
    largest = std::max(largest, contact.overlap / smaller);
  }
  return largest;
}

double mean_diameter(const Network& network) {
  if (network.grains.empty()) return not_defined;
  double sum = 0;
  for (const GrainState& grain : network.grains) sum += 2 * grain.radius;
  return sum / network.grains.size();
}

double solid_density(const Network& network) {
  double mass = 0, volume = 0;
  for (const GrainState& grain : network.grains) {
    mass += grain.mass;
    volume += solid_volume(network, grain);
  }
  return volume > 0 ? mass / volume : not_defined;
}

double inertial_number(const Matrix3& velocity_gradient, int dimension, double diameter, double density,
                       double pressure) {
  const double rate = std::sqrt(2.0) * deviator(velocity_gradient, dimension).norm();
  if (rate == 0) return 0;
  return pressure > 0 ? rate * diameter * std::sqrt(density / pressure) : std::numeric_limits<double>::infinity();
}

}  // namespace rvelab
