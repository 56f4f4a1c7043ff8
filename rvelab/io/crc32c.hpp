// CRC-32C (Castagnoli, polynomial 0x1EDC6F41 reflected, as iSCSI and ext4 use it): detects every burst up to 32 bits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace rvelab::io {

/// Checksum of bytes; `before` is that of the bytes in front of them (0: none). "123456789" gives 0xE3069283.
std::uint32_t crc32c(std::span<const std::byte> bytes, std::uint32_t before = 0);

}  // namespace rvelab::io
