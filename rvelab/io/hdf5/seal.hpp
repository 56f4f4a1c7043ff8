// The seal of a file: its length and the CRC-32C of all its bytes, in the last 24. It is checked before anything else
// reads the file. HDF5's library does not see bytes behind its own end, and takes them away when a program opens the
// file for writing: then the seal is gone, which tells such a file from a damaged one.
//
//     8 bytes "rveseal\n", uint64 length of what stands before them, uint32 version of the seal (1),
//     uint32 CRC-32C of everything before it; little-endian
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace rvelab::io {

inline constexpr std::size_t seal_bytes = 24;

/// The seal of these bytes, to be written after them.
std::array<std::byte, seal_bytes> seal_of(std::span<const std::byte> bytes);

/// Takes the seal off the bytes of a file. False: they have none. InputError naming `path`: they have one that does not
/// fit them.
bool take_seal(std::vector<std::byte>& bytes, const std::string& path);

}  // namespace rvelab::io
