// What a call of the pool led to. The numbers are those of include/rvelab/rvelab.h (held there by rvelab/abi).
#pragma once

#include <cstdint>
#include <string>

#include "rvelab/error.hpp"

namespace rvelab::pool {

enum class Status : std::int32_t {
  ok = 0,
  tolerance_missed = 1,
  not_quasi_static = 2,
  cell_thin = 3,
  tangent_affine = 4,
  discard = -1,
  bad_input = -2,
  null_pointer = -3,
  bad_id = -4,
  stale_token = -5,
  duplicate = -6,
  no_trial = -7,
  busy = -8,
  forked = -9,
  no_memory = -10,
  unsupported = -11,
  small_buffer = -12,
  bad_snapshot = -13,
  bad_file = -14,
  no_library = -15,
  no_slot = -16,
  internal = -17,
};

constexpr bool is_error(Status status) { return status < Status::discard; }

/// Order of statuses: error > DISCARD > warning > OK.
constexpr int severity(Status status) {
  if (status == Status::ok) return 0;
  if (status > Status::ok) return 1;
  return status == Status::discard ? 2 : 3;
}

/// A call that is refused, or an RVE that could not be worked on; states are as they were.
struct Refused : Error {
  Refused(Status status, const std::string& text) : Error(text), status(status) {}
  Status status;
};

/// The status of the exception that is being handled, and its text (cut to fit, always ended); allocates nothing.
Status status_of_exception(char* text, std::size_t size) noexcept;

}  // namespace rvelab::pool
