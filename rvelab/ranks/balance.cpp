// Which RVEs change their rank. Declared in ranked_pool.hpp.
#include <algorithm>
#include <numeric>

#include "rvelab/ranks/ranked_pool.hpp"

namespace rvelab::ranks {

std::vector<Move> moves_to_balance(std::span<const double> cost, std::span<const int> rank, int ranks, double allowed) {
  const auto places = std::size_t(ranks);
  std::vector<double> work(places, 0.0);
  std::vector<std::vector<std::size_t>> at(places);  // the cheapest first; ties by index
  std::vector<std::size_t> order(cost.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return cost[a] < cost[b]; });
  for (const std::size_t k : order) {
    work[std::size_t(rank[k])] += cost[k];
    at[std::size_t(rank[k])].push_back(k);
  }
  const double mean = std::accumulate(work.begin(), work.end(), 0.0) / ranks;
  std::vector<Move> moves;
  if (!(*std::max_element(work.begin(), work.end()) > (1 + allowed) * mean)) return moves;
  std::vector<bool> moved(cost.size(), false);
  while (moves.size() < cost.size()) {
    const auto busiest = std::size_t(std::max_element(work.begin(), work.end()) - work.begin());
    const auto idlest = std::size_t(std::min_element(work.begin(), work.end()) - work.begin());
    const double half = (work[busiest] - work[idlest]) / 2;
    if (half < 0.01 * mean) break;
    auto& from = at[busiest];
    auto best =
        std::upper_bound(from.begin(), from.end(), half, [&](double most, std::size_t k) { return most < cost[k]; });
    while (best != from.begin() && moved[*(best - 1)]) --best;  // each at most once
    if (best == from.begin() || cost[*(best - 1)] <= 0) break;
    const std::size_t k = *(best - 1);
    from.erase(best - 1);
    moved[k] = true;
    work[busiest] -= cost[k];
    work[idlest] += cost[k];
    auto& to = at[idlest];
    to.insert(
        std::upper_bound(to.begin(), to.end(), cost[k], [&](double of, std::size_t other) { return of < cost[other]; }),
        k);
    moves.push_back({k, int(busiest), int(idlest)});
  }
  return moves;
}

}  // namespace rvelab::ranks
