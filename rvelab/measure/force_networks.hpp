// Strong and weak contacts: those with a normal force above the mean, and the others (Radjai, Wolf, Jean and Moreau
// 1998, Phys. Rev. Lett. 80, 61). In sheared discs the strong ones, less than half of all, bear almost the whole
// deviator; the weak ones bear pressure, and nearly all that slide are among them.
#pragma once

#include "rvelab/solver/assembly/network.hpp"

namespace rvelab {

/// One of the two networks. Laboratory frame; stress in Pa, tension positive.
struct ForceNetwork {
  double contacts = 0;               ///< share of all contacts
  Matrix3 fabric = Matrix3::Zero();  ///< <n (x) n> over its contacts, trace 1; NaN without one
  double anisotropy = 0;             ///< a_c along the deviator of the whole stress (anisotropy.hpp)
  Matrix3 stress = Matrix3::Zero();  ///< its part of the contact stress
  double pressure_share = 0;         ///< of p
  double deviator_share = 0;         ///< of q: s:s_whole/s_whole:s_whole; NaN without a deviator
  double sliding = 0;                ///< share of its contacts on the Coulomb cone
};

/// Shares of both add up to 1, stresses to contact_stress(). Shares, fabrics and the mean force are NaN without
/// contacts.
struct ForceNetworks {
  double mean_normal_force = 0;  ///< N
  ForceNetwork strong, weak;
};
ForceNetworks force_networks(const Network& network);

}  // namespace rvelab
