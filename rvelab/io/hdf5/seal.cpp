#include "rvelab/io/hdf5/seal.hpp"

#include <bit>
#include <cstdint>
#include <cstring>

#include "rvelab/error.hpp"
#include "rvelab/io/crc32c.hpp"

namespace rvelab::io {
namespace {

static_assert(std::endian::native == std::endian::little, "the seal is little-endian; swap bytes here");

constexpr char seal_magic[8] = {'r', 'v', 'e', 's', 'e', 'a', 'l', '\n'};
constexpr std::uint32_t seal_version = 1;
constexpr std::size_t summed_bytes = 20;  // of the seal: all but the checksum

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw InputError(path + ": is damaged (" + what +
                   "); copy it again from where it was made, or write it again; nothing of it was read");
}

}  // namespace

std::array<std::byte, seal_bytes> seal_of(std::span<const std::byte> bytes) {
  std::array<std::byte, seal_bytes> seal;
  const std::uint64_t length = bytes.size();
  std::memcpy(seal.data(), seal_magic, sizeof seal_magic);
  std::memcpy(seal.data() + 8, &length, sizeof length);
  std::memcpy(seal.data() + 16, &seal_version, sizeof seal_version);
  const std::uint32_t sum = crc32c({seal.data(), summed_bytes}, crc32c(bytes));
  std::memcpy(seal.data() + summed_bytes, &sum, sizeof sum);
  return seal;
}

bool take_seal(std::vector<std::byte>& bytes, const std::string& path) {
  if (bytes.size() < seal_bytes) return false;
  const std::size_t found = bytes.size() - seal_bytes;
  const auto seal = std::span(bytes).subspan(found);
  if (std::memcmp(seal.data(), seal_magic, sizeof seal_magic) != 0) return false;
  std::uint64_t length = 0;
  std::uint32_t version = 0, sum = 0;
  std::memcpy(&length, seal.data() + 8, sizeof length);
  std::memcpy(&version, seal.data() + 16, sizeof version);
  std::memcpy(&sum, seal.data() + summed_bytes, sizeof sum);
  if (length != found) {
    refuse(path, "it has " + std::to_string(found) + " bytes, its seal says " + std::to_string(length));
  }
  if (crc32c(seal.first(summed_bytes), crc32c(std::span(bytes).first(length))) != sum) {
    refuse(path, "its checksum does not fit its bytes");
  }
  if (version != seal_version) {
    throw InputError(path + ": has a seal of version " + std::to_string(version) +
                     "; allowed: " + std::to_string(seal_version) + "; open it with a newer rvelab");
  }
  bytes.resize(length);
  return true;
}

}  // namespace rvelab::io
