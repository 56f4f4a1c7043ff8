// Ids of RVEs: pool tag (10 bits), generation (17), slot (26): 53 bits, exact in a double.
//
// A slot that is released gets the next generation, so that the old id is seen to be stale; when its generations are
// used up it is retired. Single precision keeps 24 bits: with a tag above zero it changes the lowest 20 bits of the
// slot to zeros. Slots whose lowest 20 bits are zero are never used, so that a rounded id is seen to be one.
#pragma once

#include <cstdint>

namespace rvelab::pool {

constexpr int slot_bits = 26, generation_bits = 17, tag_bits = 10;
constexpr std::uint32_t slot_limit = 1u << slot_bits;              ///< slots are below
constexpr std::uint32_t generation_limit = 1u << generation_bits;  ///< generations are below, and above 0
constexpr std::uint32_t tag_limit = 1u << tag_bits;                ///< tags are below, and above 0

struct Id {
  std::uint32_t tag = 0, generation = 0, slot = 0;

  static constexpr Id of(std::int64_t value) {
    return {std::uint32_t(value >> (slot_bits + generation_bits)),
            std::uint32_t(value >> slot_bits) & (generation_limit - 1), std::uint32_t(value) & (slot_limit - 1)};
  }
  constexpr std::int64_t value() const {
    return std::int64_t(tag) << (slot_bits + generation_bits) | std::int64_t(generation) << slot_bits | slot;
  }
};

/// Whether a slot may be in use; others hold nothing.
constexpr bool is_usable(std::uint32_t slot) { return (slot & ((1u << 20) - 1)) != 0; }

}  // namespace rvelab::pool
