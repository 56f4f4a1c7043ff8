#include "rvelab/measure/force_networks.hpp"

#include <cmath>
#include <limits>

#include "rvelab/measure/deviator.hpp"
#include "rvelab/measure/measures.hpp"

namespace rvelab {
namespace {

/// Measures of the contacts in `part`, a copy of `whole` without the others.
ForceNetwork measured(const Network& whole, const Network& part) {
  const int dimension = whole.dimension();
  const Matrix3 whole_stress = contact_stress(whole), s = -deviator(whole_stress, dimension);
  ForceNetwork found;
  found.contacts = double(part.contacts.size()) / double(whole.contacts.size());
  found.fabric = fabric(part);
  found.anisotropy = (dimension == 2 ? 4 * std::sqrt(0.5) : 7.5 * std::sqrt(1.5)) * found.fabric.cwiseProduct(s).sum() /
                     (s.norm() > 0 ? s.norm() : 1);
  found.stress = contact_stress(part);
  found.pressure_share = mean_pressure(found.stress, dimension) / mean_pressure(whole_stress, dimension);
  found.deviator_share = -deviator(found.stress, dimension).cwiseProduct(s).sum() / s.squaredNorm();
  found.sliding = sliding_fraction(part);
  return found;
}

}  // namespace

ForceNetworks force_networks(const Network& network) {
  ForceNetworks found;
  if (network.contacts.empty()) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    const Matrix3 zero = Matrix3::Zero();
    const ForceNetwork part{none, Matrix3::Constant(none), none, zero, none, none, none};
    return {none, part, part};
  }
  for (const ContactState& contact : network.contacts) found.mean_normal_force += contact.normal_force;
  found.mean_normal_force /= double(network.contacts.size());
  Network strong = network, weak = network;
  std::erase_if(strong.contacts, [&](const ContactState& c) { return c.normal_force <= found.mean_normal_force; });
  std::erase_if(weak.contacts, [&](const ContactState& c) { return c.normal_force > found.mean_normal_force; });
  found.strong = measured(network, strong);
  found.weak = measured(network, weak);
  return found;
}

}  // namespace rvelab
