// Secant shear modulus and damping ratio of the loops of a cyclic test (Hardin and Drnevich 1972; Kramer 1996, section
// 6.4):
//   G = dtau/dgamma     D = area of the loop/(pi/2 dtau dgamma)
// dgamma and dtau are differences between the turn at which the loop opens and closes (their mean) and the opposite
// one, the area is the work of one cycle per volume. Of a loop about the origin D = Delta W/(4 pi W), W the energy at
// the amplitude. Simple shear: tau and gamma of its plane. Compression: tau = (sigma_a - sigma_r)/2, gamma = eps_a -
// eps_r, the largest shear; sigma_r, eps_r the mean of the lateral ones.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "rvelab/records/record.hpp"

namespace rvelab::ensemble {

struct Loop {
  double gamma = 0;          ///< amplitude of the shear strain
  double G = 0;              ///< Pa
  double damping_ratio = 0;  ///< D
};

/// The whole loops of one stage, from the first turn of the driving strain on, each between a turn and the next but
/// one. `axis`: "x", "y", "z" of a compression, "xy", "xz", "yz" of simple shear; none: no loop.
std::vector<Loop> loops_of(std::span<const records::Record> stage, const std::string& axis, int dimension);

/// Secant modulus from the first record to the first one at or beyond `gamma` of its strain, Pa: G_max where no probe
/// gave it. NaN without.
double initial_shear_modulus(std::span<const records::Record> stage, const std::string& axis, int dimension,
                             double gamma = 0);

/// G_max, Pa, and what gave it.
struct ReferenceModulus {
  double G = 0;
  const char* of = "";  ///< "probe", "first record" or "stiffest loop"
};

/// G_max of a cyclic stage with these loops: the mean shear stiffness of the first probe of its test; else the secant
/// to the first record, or the stiffest loop where that is stiffer, so that no loop is above it.
ReferenceModulus reference_modulus(std::span<const records::Record> stage, const std::vector<Loop>& loops,
                                   const std::vector<records::ProbeResult>& probes, const std::string& axis,
                                   int dimension);

}  // namespace rvelab::ensemble
