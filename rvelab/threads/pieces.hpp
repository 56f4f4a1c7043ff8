// Loops over many grains in blocks, shared by a team if the work exceeds the cost of synchronisation.
#pragma once

#include <cstddef>

#include "rvelab/threads/workers.hpp"

namespace rvelab {

/// Least number of grains of a cell for which a team shares the work: two synchronisations a step cost some 20 us.
constexpr std::size_t least_shared_grains = 30'000;

/// Length of a block of work that is done once a list, not once a step.
constexpr std::size_t piece_length = 4096;
constexpr std::size_t pieces_in(std::size_t count) { return (count + piece_length - 1) / piece_length; }

/// Calls work(block, first, last) for all blocks of `count` items; on the team if there is one.
template <class Work>
void in_pieces(std::size_t count, Workers* team, const Work& work) {
  const auto one = [&](std::size_t k) {
    const std::size_t end = (k + 1) * piece_length;
    work(k, k * piece_length, end < count ? end : count);
  };
  if (team != nullptr && pieces_in(count) > 1)
    team->for_each(pieces_in(count), [&one](std::size_t k) { one(k); });
  else
    for (std::size_t k = 0; k < pieces_in(count); ++k) one(k);
}

}  // namespace rvelab
