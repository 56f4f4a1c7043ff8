#include "rvelab/io/seal.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <vector>

#include "rvelab/error.hpp"
#include "rvelab/io/crc32c.hpp"
#include "rvelab/io/descriptor.hpp"

namespace rvelab::io {
namespace {

static_assert(std::endian::native == std::endian::little, "the seal is little-endian; swap bytes here");

constexpr char magic[8] = {'r', 'v', 'e', 's', 'e', 'a', 'l', '\n'};
constexpr std::uint32_t seal_version = 1;
constexpr std::size_t summed_bytes = 20;  // of the seal: all but the checksum

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw InputError(path + ": is damaged (" + what +
                   "); copy it again from where it was made, or write it again; nothing of it was read");
}

/// InputError if there are fewer bytes.
void read_whole(int file, std::uint64_t offset, std::span<std::byte> bytes, const std::string& path) {
  if (read_at(file, offset, bytes) < bytes.size()) refuse(path, "it cannot be read to its end");
}

}  // namespace

std::array<std::byte, seal_bytes> seal_of(std::span<const std::byte> bytes) {
  std::array<std::byte, seal_bytes> seal;
  const std::uint64_t length = bytes.size();
  std::memcpy(seal.data(), magic, sizeof magic);
  std::memcpy(seal.data() + 8, &length, sizeof length);
  std::memcpy(seal.data() + 16, &seal_version, sizeof seal_version);
  const std::uint32_t sum = crc32c({seal.data(), summed_bytes}, crc32c(bytes));
  std::memcpy(seal.data() + summed_bytes, &sum, sizeof sum);
  return seal;
}

bool check_seal(int descriptor, const std::string& path) {
  struct stat status;
  if (::fstat(descriptor, &status) != 0) refuse(path, std::strerror(errno));
  const auto size = static_cast<std::uint64_t>(status.st_size);
  std::array<std::byte, seal_bytes> seal;
  if (size < seal.size()) return false;
  read_whole(descriptor, size - seal.size(), seal, path);
  if (std::memcmp(seal.data(), magic, sizeof magic) != 0) return false;

  std::uint64_t length = 0;
  std::uint32_t version = 0, stated = 0;
  std::memcpy(&length, seal.data() + 8, sizeof length);
  std::memcpy(&version, seal.data() + 16, sizeof version);
  std::memcpy(&stated, seal.data() + summed_bytes, sizeof stated);
  if (length != size - seal.size()) {
    refuse(path, "it has " + std::to_string(size - seal.size()) + " bytes, its seal says " + std::to_string(length));
  }
  std::vector<std::byte> part(std::min<std::uint64_t>(length, 1 << 20));
  std::uint32_t sum = 0;
  for (std::uint64_t at = 0; at < length; at += part.size()) {
    const std::span<std::byte> bytes(part.data(), std::min<std::uint64_t>(part.size(), length - at));
    read_whole(descriptor, at, bytes, path);
    sum = crc32c(bytes, sum);
  }
  if (crc32c({seal.data(), summed_bytes}, sum) != stated) refuse(path, "its checksum does not fit its bytes");
  if (version != seal_version) {
    throw InputError(path + ": has a seal of version " + std::to_string(version) +
                     "; allowed: " + std::to_string(seal_version) + "; open it with a newer rvelab");
  }
  return true;
}

}  // namespace rvelab::io
