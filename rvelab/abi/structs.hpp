// Structs of the interface in any of their sizes: an older host has a smaller one, a newer host a larger one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace rvelab::abi {

/// Refuses sizes that are no struct's, and bytes beyond `own` that are not zero, of a struct that begins with
/// struct_size and flags. Throws pool::Refused (bad_input, unsupported). Returns struct_size.
std::size_t checked_size(const void* given, std::size_t own, const char* name);

/// Refuses flags that are not zero.
void expect_no_flags(std::uint32_t flags, const char* name);

/// A struct of a host; fields that it does not have are zero.
template <class Struct>
Struct read_struct(const Struct* given, const char* name) {
  const std::size_t size = checked_size(given, sizeof(Struct), name);
  Struct own{};
  std::memcpy(&own, given, size < sizeof own ? size : sizeof own);
  expect_no_flags(own.flags, name);
  return own;
}

/// Writes min(size, own size) bytes of a struct whose fields are at their defaults; struct_size is `size`.
template <class Struct>
void init_struct(Struct* given, std::size_t size) {
  Struct own{};
  own.struct_size = std::uint32_t(size);
  std::memcpy(static_cast<void*>(given), &own, size < sizeof own ? size : sizeof own);
}

/// Refuses sizes that init cannot write down.
void expect_size(std::size_t size, const char* name);

}  // namespace rvelab::abi
