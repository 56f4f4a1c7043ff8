#include "rvelab/abi/structs.hpp"

#include <string>

namespace rvelab::abi {

namespace {

using pool::Refused;
using pool::Status;

/// Whether the fields follow one another without a gap up to the end of the struct.
template <class Struct>
constexpr bool is_whole() {
  std::size_t end = 0;
  for (const Field& field : Layout<Struct>::fields) {
    if (field.begin != end) return false;
    end = field.end;
  }
  return end == sizeof(Struct);
}
static_assert(is_whole<rvelab_pool_def>() && is_whole<rvelab_batch>() && is_whole<rvelab_info>() &&
              is_whole<rvelab_array>() && is_whole<rvelab_mixed>());

constexpr std::size_t least = 8, most = 65536;  ///< struct_size and flags; more than any struct will ever have

std::string size_in_words(std::size_t size, const char* name) {
  return std::string(name) + ".struct_size is " + std::to_string(size);
}

std::string remedy(const char* name) { return std::string("; give sizeof(") + name + "), by " + name + "_init"; }

}  // namespace

void expect_size(std::size_t size, const char* name, std::span<const Field> fields) {
  if (size < least || size > most) throw Refused(Status::bad_input, size_in_words(size, name) + remedy(name));
  for (const Field& field : fields)
    if (field.begin < size && size < field.end)
      throw Refused(Status::bad_input, size_in_words(size, name) + ", which ends within the field " + field.name +
                                           " (bytes " + std::to_string(field.begin) + " to " +
                                           std::to_string(field.end) + ")" + remedy(name));
}

std::size_t checked_size(const void* given, const char* name, std::span<const Field> fields,
                         std::uint32_t known_flags) {
  std::uint32_t head[2];  // struct_size and flags
  std::memcpy(head, given, sizeof head);
  const std::size_t size = head[0];
  expect_size(size, name, fields);
  const auto* const bytes = static_cast<const unsigned char*>(given);
  const std::size_t own = fields.back().end;
  for (std::size_t at = own; at < size; ++at)
    if (bytes[at] != 0)
      throw Refused(Status::unsupported, std::string(name) + ": the byte at offset " + std::to_string(at) +
                                             " is not zero, and this version knows " + std::to_string(own) +
                                             " bytes; leave later fields at zero, or use a later librvelab");
  if ((head[1] & ~known_flags) != 0)
    throw Refused(Status::unsupported,
                  std::string(name) + ".flags is " + std::to_string(head[1]) + "; this version knows " +
                      (known_flags == 0 ? "none: give 0" : std::to_string(known_flags) + " alone: give that, or 0"));
  return size;
}

}  // namespace rvelab::abi
