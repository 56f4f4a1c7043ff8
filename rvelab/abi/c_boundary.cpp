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

void expect_pointers(std::initializer_list<Needed> needed) {
  for (const Needed& each : needed)
    if (each.pointer == nullptr)
      throw pool::Refused(pool::Status::null_pointer, std::string(each.name) + " is null; give a pointer");
}

std::span<const std::int64_t> ids_of(std::int64_t n, const std::int64_t* ids) {
  if (n < 0) throw pool::Refused(pool::Status::bad_input, "n is " + std::to_string(n) + "; allowed: 0 or more");
  if (n > 0) expect_pointers({{ids, "ids"}});
  static const std::int64_t none = 0;  // a pointer that is not null: no ids are meant, not all
  return {n > 0 ? ids : &none, std::size_t(n)};
}

}  // namespace rvelab::abi

const char* rvelab_last_error(void) { return rvelab::abi::text; }
