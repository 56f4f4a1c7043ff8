// The gather table (kernels/configuration.hpp, GrainArrays): which force rows each grain adds up, laid out for loops of
// equal length.
#pragma once

#include <algorithm>

#include "rvelab/solver/assembly/assembly.hpp"

namespace rvelab {

/// Fills slot_begin, slots and tasks of the table for its listed pairs, in their order; a force row is `force_row`
/// doubles.
void fill_gather_table(std::size_t padded_grains, std::int32_t force_row, PairTable& pairs);

/// Fills `gathered` and `slots_beyond` as after listing: no pair beyond `near` has touched.
void leave_out_pairs_beyond(std::int32_t force_row, PairTable& pairs);

/// After a loop over the pairs of these indices, multiples of eight: the force rows of those beyond `near` are gathered
/// from their first contact on.
void gather_pairs_that_touch(PairTable& pairs, std::size_t first, std::size_t last);
inline void gather_pairs_that_touch(PairTable& pairs) { gather_pairs_that_touch(pairs, pairs.near, pairs.padded()); }

/// Calls at(grain, pair, as_j) for every pair of the grains [first, last), multiples of a chunk but for the end: for
/// each grain in the order of (i, j, image), since the pairs in which it is j all come before those in which it is i.
template <int D, class At>
void each_pair_of_grains(const PairTable& pairs, std::size_t first, std::size_t last, const At& at) {
  constexpr std::int32_t force_row = force_row_length(D);
  const auto chunk = std::size_t(chunk_grains), padded = pairs.tasks.size() / 2;
  for (std::size_t start = first; start < last; start += chunk) {
    const std::size_t end = std::min(start + chunk, padded);
    for (const bool as_j : {true, false})
      for (std::size_t k = 2 * start; k < 2 * end; ++k) {
        const std::size_t task = pairs.tasks[k] / 4, block = k / 4;
        if ((task < chunk) != as_j) continue;
        for (auto slot = pairs.slot_begin[block]; slot < pairs.slot_begin[block + 1]; ++slot) {
          const auto pair = std::size_t(pairs.slots[4 * std::size_t(slot) + k % 4] / force_row);
          if (pair >= pairs.listed) break;  // padding: tasks of the block have more pairs than this one
          at(start + (as_j ? task : task - chunk), pair, as_j);
        }
      }
  }
}

}  // namespace rvelab
