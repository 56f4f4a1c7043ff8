#include "rvelab/solver/assembly/gather_table.hpp"

#include <algorithm>

namespace rvelab {

namespace {

/// Tasks of a chunk, those with most pairs first; ties in order of the task.
void sort_tasks(const std::int32_t* pairs_of, int tasks, std::vector<std::int32_t>& first, std::vector<int>& sorted) {
  const std::int32_t most = *std::max_element(pairs_of, pairs_of + tasks);
  first.assign(std::size_t(most) + 2, 0);
  for (int t = 0; t < tasks; ++t) ++first[std::size_t(most - pairs_of[t]) + 1];
  for (std::size_t k = 1; k < first.size(); ++k) first[k] += first[k - 1];
  sorted.resize(std::size_t(tasks));
  for (int t = 0; t < tasks; ++t) sorted[std::size_t(first[std::size_t(most - pairs_of[t])]++)] = t;
}

}  // namespace

void fill_gather_table(std::size_t padded_grains, std::int32_t force_row, PairTable& pairs) {
  const auto chunk = std::size_t(chunk_grains);
  // Tasks in the order of the chunks: grains of the chunk as j, then as i. Grain g of a chunk that starts at c and has
  // n grains has tasks 2 c + (g - c) and 2 c + n + (g - c).
  const auto chunk_of = [&](std::size_t g) { return g / chunk * chunk; };
  const auto grains_in = [&](std::size_t start) { return std::min(chunk, padded_grains - start); };
  const auto as_j = [&](std::size_t g) { return chunk_of(g) + g; };
  const auto as_i = [&](std::size_t g) { return as_j(g) + grains_in(chunk_of(g)); };
  std::vector<std::int32_t> pairs_of(2 * padded_grains, 0);
  for (std::size_t q = 0; q < pairs.listed; ++q) {
    ++pairs_of[as_j(std::size_t(pairs.j[q]))];
    ++pairs_of[as_i(std::size_t(pairs.i[q]))];
  }
  const std::size_t blocks = padded_grains / 2;
  pairs.slot_begin.assign(blocks + 1, 0);
  pairs.tasks.resize(4 * blocks);
  std::vector<std::int32_t> next(2 * padded_grains);  // first the lane and block of the task, then its next slot
  std::vector<std::int32_t> first;
  std::vector<int> sorted;
  for (std::size_t start = 0; start < padded_grains; start += chunk) {
    const std::size_t grains = grains_in(start);
    sort_tasks(pairs_of.data() + 2 * start, int(2 * grains), first, sorted);
    for (std::size_t k = 0; k < 2 * grains; ++k) {
      const auto task = std::size_t(sorted[k]);
      const std::size_t block = (2 * start + k) / 4;
      if (k % 4 == 0) pairs.slot_begin[block + 1] = pairs.slot_begin[block] + pairs_of[2 * start + task];
      pairs.tasks[2 * start + k] = std::uint16_t(4 * (task < grains ? task : chunk + (task - grains)));
      next[2 * start + task] = 4 * pairs.slot_begin[block] + std::int32_t(k % 4);
    }
  }
  const auto nothing = force_row * std::int32_t(pairs.listed);  // the first padding pair
  pairs.slots.assign(4 * std::size_t(pairs.slot_begin[blocks]), nothing);
  for (const std::int32_t row : pairs.order) {
    const auto q = std::size_t(row);
    for (const std::size_t task : {as_j(std::size_t(pairs.j[q])), as_i(std::size_t(pairs.i[q]))}) {
      pairs.slots[std::size_t(next[task])] = force_row * std::int32_t(q);
      next[task] += 4;
    }
  }
  leave_out_pairs_beyond(force_row, pairs);
}

void leave_out_pairs_beyond(std::int32_t force_row, PairTable& pairs) {
  const auto beyond = force_row * std::int32_t(pairs.near), nothing = force_row * std::int32_t(pairs.listed);
  pairs.gathered = pairs.slots;
  pairs.slots_beyond.assign(2 * (pairs.padded() - pairs.near), -1);
  for (std::size_t slot = 0; slot < pairs.slots.size(); ++slot) {
    const std::int32_t row = pairs.slots[slot];
    if (row < beyond || row >= nothing) continue;
    std::int32_t* of_pair = pairs.slots_beyond.data() + 2 * ((row - beyond) / force_row);
    of_pair[of_pair[0] < 0 ? 0 : 1] = std::int32_t(slot);
    pairs.gathered[slot] = nothing;
  }
}

void gather_pairs_that_touch(PairTable& pairs, std::size_t first, std::size_t last) {
  for (std::size_t eight = std::max(first, pairs.near) / 8; eight < last / 8; ++eight) {
    const std::int32_t* slots_of = pairs.slots_beyond.data() + 2 * (8 * eight - pairs.near);
    if (pairs.touched[eight] == 0 || slots_of[0] < 0) continue;  // nothing but padding, in a lattice that is not finite
    if (pairs.gathered[std::size_t(slots_of[0])] == pairs.slots[std::size_t(slots_of[0])]) continue;
    for (int k = 0; k < 16 && slots_of[k] >= 0; ++k)
      pairs.gathered[std::size_t(slots_of[k])] = pairs.slots[std::size_t(slots_of[k])];
  }
}

}  // namespace rvelab
