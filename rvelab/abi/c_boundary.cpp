#include "rvelab/abi/c_boundary.hpp"

#include <cstdio>

namespace rvelab::abi {

namespace {

/// A plain array, so that a text always finds room.
thread_local char text[1200];

}  // namespace

std::int32_t recorded(const pool::Verdict& verdict) noexcept {
  std::snprintf(text, sizeof text, "%s", verdict.text.c_str());
  return std::int32_t(verdict.status);
}

std::int32_t recorded_failure() noexcept { return std::int32_t(pool::status_of_exception(text, sizeof text)); }

const char* last_text() noexcept { return text; }

void expect_pointer(const void* pointer, const char* name) {
  if (pointer == nullptr)
    throw pool::Refused(pool::Status::null_pointer, std::string(name) + " is null; give a pointer");
}

}  // namespace rvelab::abi
