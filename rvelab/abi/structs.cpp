#include "rvelab/abi/structs.hpp"

#include <string>

#include "rvelab/pool/status.hpp"

namespace rvelab::abi {

namespace {

using pool::Refused;
using pool::Status;

constexpr std::size_t least = 8, most = 65536;  ///< struct_size and flags; more than any struct will ever have

}  // namespace

void expect_size(std::size_t size, const char* name) {
  if (size < least || size > most)
    throw Refused(Status::bad_input, std::string(name) + ".struct_size is " + std::to_string(size) + "; give sizeof(" +
                                         name + "), by " + name + "_init");
}

std::size_t checked_size(const void* given, std::size_t own, const char* name) {
  std::uint32_t size = 0;
  std::memcpy(&size, given, sizeof size);
  expect_size(size, name);
  const auto* const bytes = static_cast<const unsigned char*>(given);
  for (std::size_t at = own; at < size; ++at)
    if (bytes[at] != 0)
      throw Refused(Status::unsupported, std::string(name) + ": the byte at offset " + std::to_string(at) +
                                             " is not zero, and this version knows " + std::to_string(own) +
                                             " bytes; leave later fields at zero, or use a later librvelab");
  return size;
}

void expect_no_flags(std::uint32_t flags, const char* name) {
  if (flags != 0)
    throw Refused(Status::unsupported,
                  std::string(name) + ".flags is " + std::to_string(flags) + "; this version knows none: give 0");
}

}  // namespace rvelab::abi
