#include "rvelab/abi/c_boundary.hpp"

#include <cstdio>
#include <cstring>

#include "rvelab/io/utf8.hpp"

namespace rvelab::abi {

namespace {

/// A plain array, so that a text always finds room.
thread_local char text[1200];

/// What a name in the text holds that hosts cannot print, and a letter that its end cuts, becomes a question mark.
std::int32_t printable(pool::Status status) noexcept {
  const std::size_t size = std::strlen(text);
  for (std::size_t at = 0; at < size;) {
    const std::size_t length = io::utf8_length({text, size}, at);
    const auto byte = static_cast<unsigned char>(text[at]);
    if (length == 0 || (byte < 0x20 && byte != '\n') || byte == 0x7f) text[at] = '?';
    at += length > 0 ? length : 1;
  }
  return std::int32_t(status);
}

}  // namespace

std::int32_t recorded(const pool::Verdict& verdict) noexcept {
  std::snprintf(text, sizeof text, "%s", verdict.text.c_str());
  return printable(verdict.status);
}

std::int32_t recorded_failure() noexcept { return printable(pool::status_of_exception(text, sizeof text)); }

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
