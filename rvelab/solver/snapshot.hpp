// What a snapshot begins with, and its checksum. The fields of the specimen follow (specimen_fields.hpp), in this
// machine's byte order: a list or a table begins with its length, a text too, and a table stands column by column.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "rvelab/specimen/specimen.hpp"

namespace rvelab {

/// Bytes of a specimen and back. InputError if the bytes cannot be such of this build (see Rve::restore).
std::vector<std::byte> to_bytes(const Specimen& specimen);
Specimen from_bytes(std::span<const std::byte> bytes);

struct SnapshotHead {
  char magic[8];           ///< "rvesnap" and the version of this head
  std::uint64_t layout;    ///< checksum of the names, units and types of all fields: another one is another build
  std::uint64_t length;    ///< bytes that follow
  std::uint64_t checksum;  ///< of these bytes
};
static_assert(sizeof(SnapshotHead) == 32);

/// 64 bits over bytes, eight words at a time in sums of their own, each by the round of XXH64 (Collet 2012):
/// sum <- rotl(sum + word p2, 31) p1. With odd factors a round is one to one in the sum and in the word: bytes that
/// differ in one word never have the same checksum, others by chance only. Both factors are needed: with one, the
/// highest bit of a word reaches one bit of the sum, where a bit of a later word takes it back.
inline std::uint64_t snapshot_checksum(std::span<const std::byte> bytes) {
  constexpr std::uint64_t p1 = 11400714785074694791ULL, p2 = 14029467366897019727ULL;
  constexpr std::size_t lanes = 8, stride = lanes * sizeof(std::uint64_t);
  const auto round = [](std::uint64_t sum, std::uint64_t word) { return std::rotl(sum + word * p2, 31) * p1; };
  std::uint64_t sums[lanes];
  for (std::size_t k = 0; k < lanes; ++k) sums[k] = p1 * (k + 1);
  const auto add = [&](const std::byte* from) {
    std::uint64_t words[lanes];
    std::memcpy(words, from, stride);
    for (std::size_t k = 0; k < lanes; ++k) sums[k] = round(sums[k], words[k]);
  };
  const std::size_t rest = bytes.size() % stride, whole = bytes.size() - rest;
  for (std::size_t at = 0; at < whole; at += stride) add(bytes.data() + at);
  if (rest > 0) {
    std::byte last[stride] = {};
    std::memcpy(last, bytes.data() + whole, rest);
    add(last);
  }
  std::uint64_t total = round(p1, bytes.size());
  for (const std::uint64_t sum : sums) total = round(total, sum);
  return total ^ (total >> 33);
}

}  // namespace rvelab
