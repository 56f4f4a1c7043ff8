// The boundary between a host in C and the library: inside, the default floating-point environment; outside, a status
// and a text in the place of exceptions.
#pragma once

#include <utility>

#include "rvelab/pool/floating_point.hpp"
#include "rvelab/pool/pool.hpp"

namespace rvelab::abi {

/// Records the text for rvelab_last_error; returns the status as a number.
std::int32_t recorded(const pool::Verdict& verdict) noexcept;
/// The same of the exception that is being handled.
std::int32_t recorded_failure() noexcept;
/// Text of the last call on this thread that was not ok.
const char* last_text() noexcept;

/// Runs `call`, which returns a pool::Verdict or nothing (ok).
template <class Call>
std::int32_t at_c_boundary(Call&& call) noexcept {
  const pool::FloatingPoint environment;
  try {
    if constexpr (std::is_void_v<decltype(call())>) {
      call();
      return 0;
    } else {
      const pool::Verdict verdict = call();
      return verdict.status == pool::Status::ok ? 0 : recorded(verdict);
    }
  } catch (...) {
    return recorded_failure();
  }
}

/// Throws Refused (null_pointer) naming the argument.
void expect_pointer(const void* pointer, const char* name);

}  // namespace rvelab::abi
