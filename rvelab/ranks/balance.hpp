// Which RVEs change their rank so that all ranks have the same work.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace rvelab::ranks {

struct Move {
  std::size_t index = 0;  ///< of the RVE in what was given
  int from = 0, to = 0;
};

/// `cost[k]`: expected work of an RVE, grain-steps, at rank `rank[k]` of `ranks`. None if the busiest rank has at most
/// `allowed` (0.1: 10 %) more than the mean. Else from the busiest rank to the idlest, again and again, the RVE that
/// takes most of what they differ by: half of it at most, and not below a hundredth of the mean. Longest processing
/// time first (Graham 1969), but that what is in its place stays.
std::vector<Move> moves_to_balance(std::span<const double> cost, std::span<const int> rank, int ranks, double allowed);

}  // namespace rvelab::ranks
