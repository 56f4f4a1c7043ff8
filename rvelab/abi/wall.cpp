#include "rvelab/abi/wall.hpp"

#include <cstdio>

namespace rvelab::abi {

namespace {

/// Room for a text; a plain array, so that there is always one.
thread_local char text[1200];

}  // namespace

std::int32_t told(const pool::Verdict& verdict) noexcept {
  std::snprintf(text, sizeof text, "%s", verdict.text.c_str());
  return std::int32_t(verdict.status);
}

std::int32_t told_failure() noexcept { return std::int32_t(pool::status_of_exception(text, sizeof text)); }

const char* last_text() noexcept { return text; }

void expect_pointer(const void* pointer, const char* name) {
  if (pointer == nullptr)
    throw pool::Refused(pool::Status::null_pointer, std::string(name) + " is null; give a pointer");
}

}  // namespace rvelab::abi
