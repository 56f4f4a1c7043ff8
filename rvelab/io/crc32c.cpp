#include "rvelab/io/crc32c.hpp"

#include <array>

namespace rvelab::io {
namespace {

/// tables[k][b]: what the byte b adds to the remainder when k further bytes follow it in a group of eight.
using Tables = std::array<std::array<std::uint32_t, 256>, 8>;

constexpr Tables make_tables() {
  constexpr std::uint32_t reflected_polynomial = 0x82F63B78;
  Tables tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t remainder = byte;
    for (int bit = 0; bit < 8; ++bit) remainder = (remainder >> 1) ^ ((remainder & 1) != 0 ? reflected_polynomial : 0);
    tables[0][byte] = remainder;
  }
  for (std::size_t k = 1; k < tables.size(); ++k) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t before = tables[k - 1][byte];
      tables[k][byte] = (before >> 8) ^ tables[0][before & 0xFF];
    }
  }
  return tables;
}

constexpr Tables tables = make_tables();

}  // namespace

std::uint32_t crc32c(std::span<const std::byte> bytes, std::uint32_t before) {
  std::uint32_t remainder = ~before;
  const auto byte = [&](std::size_t k) { return std::uint32_t(bytes[k]); };
  for (; bytes.size() >= 8; bytes = bytes.subspan(8)) {
    const std::uint32_t low = remainder ^ (byte(0) | byte(1) << 8 | byte(2) << 16 | byte(3) << 24);
    remainder = tables[7][low & 0xFF] ^ tables[6][low >> 8 & 0xFF] ^ tables[5][low >> 16 & 0xFF] ^
                tables[4][low >> 24] ^ tables[3][byte(4)] ^ tables[2][byte(5)] ^ tables[1][byte(6)] ^
                tables[0][byte(7)];
  }
  for (std::size_t k = 0; k < bytes.size(); ++k) remainder = (remainder >> 8) ^ tables[0][(remainder ^ byte(k)) & 0xFF];
  return ~remainder;
}

}  // namespace rvelab::io
