// Random numbers of a pair of grains, the same whatever the order of the grains and lists. Internal to the module.
#pragma once

#include <cstdint>

#include "rvelab/grains/uniform.hpp"
#include "rvelab/specimen/specimen.hpp"

namespace rvelab::protocol {

/// What they are drawn for: draws of one seed must not go together.
enum class Draw { cement, dissolution };

/// `pair` has i and j. Of several images of one pair all have the same numbers: an image goes with where the grains
/// were wrapped.
template <class Pair>
Uniform numbers_of_pair(const Specimen& s, const Pair& pair, std::uint64_t seed, Draw draw) {
  std::uint64_t stream = 0;
  const auto mix = [&](std::int64_t value) {
    stream = (stream ^ std::uint64_t(value)) * 0x9e3779b97f4a7c15ULL;
    stream ^= stream >> 32;
  };
  mix(s.grains.id[std::size_t(pair.i)]);
  mix(s.grains.id[std::size_t(pair.j)]);
  if (draw != Draw::cement) mix(std::int64_t(draw));
  return Uniform(seed, stream | 1);
}

}  // namespace rvelab::protocol
