// Dissolution of cement between grains: bonds (rvelab/interaction/parallel_bond.hpp) lose radius or strength.
//
// The rim of a bond dissolves and takes with it what it carried; the cement that is left keeps its strain, and so its
// stress, until the grains move. With the sections A, I, J before and A', I', J' after,
//   f_n = kn A' (l0 - l),   f_s <- f_s A'/A,   M_b <- M_b I'/I,   M_t <- M_t J'/J
// and each spring gives up the share of its energy that was in the rim: it falls by (1 - A'/A) for forces, (1 - I'/I)
// for moments. If the forces stayed instead, the energy f^2/(2 k A') of what is left would grow at once, though nothing
// does work on it; what the lost rim bore is for the neighbours to take up, while the grains move. Where cement is a
// phase of its own, its share of stress and energy falls with its volume in the same way (Tengattini et al. 2014, J.
// Mech. Phys. Solids 70, 281). Falling strengths change no force: a bond that does not bear its own any more breaks at
// once, by its law.
#pragma once

#include <cstdint>
#include <string>

#include "rvelab/solver/rve.hpp"

namespace rvelab::protocol {

/// Which intact bonds lose what.
struct Dissolution {
  double radius = 1;       ///< part of its radius that is left of a bond at the end, > 0
  double strength = 1;     ///< the same of both its strengths; 0: nothing
  double share = 1;        ///< of the bonds, drawn by seed
  std::uint64_t seed = 0;  ///< the same bonds for the same seed, whichever of them broke meanwhile
  std::string material;    ///< only bonds with a grain of this material; "": all
};

struct Dissolved {
  Interactions interactions;
  std::size_t bonds = 0;  ///< intact ones that lose something
};

/// What is wrong with its material on a specimen; "": nothing.
std::string lacking_in(const Specimen& specimen, const Dissolution& dissolution);

/// The interactions of an Rve after `part` (0 to 1) of a dissolution of which `before` (less than that) is done:
/// radius and strengths fall as straight lines. The energy that a bond gives up is added to its released energy.
/// Contacts and broken bonds stay as they are. InputError if the specimen has no such material.
Dissolved dissolved(const Rve& rve, const Dissolution& dissolution, double before, double part);

}  // namespace rvelab::protocol
