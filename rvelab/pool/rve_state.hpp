// What a snapshot and a pool file keep of one RVE: its committed state, its tokens, and what its measures refer to.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "rvelab/pool/tokens.hpp"
#include "rvelab/specimen/specimen.hpp"

namespace rvelab::pool {

struct RveState {
  Specimen specimen;
  Tokens tokens;
  double initial_void_ratio = 0;  ///< when the RVE was spawned
  double inertial_number = 0;     ///< of the last committed step
};

/// Bitwise, for builds with the same fields: a head with magic, length and checksum, tokens, the bytes of Rve::save().
/// `specimen`: these bytes; state.specimen is not looked at.
std::vector<std::byte> to_bytes(const RveState& state, std::span<const std::byte> specimen);

/// Throws Refused (bad_snapshot) if the bytes are not such, were cut or changed, or are of another build.
RveState rve_state_of(std::span<const std::byte> bytes);

}  // namespace rvelab::pool
