// Which RVEs change their rank, and states that go to a file and to other numbers of ranks.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/ranks/local_ranks.hpp"

using namespace rvelab;
using namespace rvelab::test;

TEST_CASE("the states of a pool over ranks go to a file and into pools of other sizes") {
  const auto first = over(3, one_thread());
  std::vector<std::int64_t> ids(7);
  first->spawn(first->add_template(packed(4)), 7, ids.data());
  Draw draw(3);
  trial(*first, ids, draw.gradients(7, 1e-4));
  first->commit({});
  first->release(std::vector{ids[2]});
  pool::Population kept;
  std::vector<Bytes> states;
  first->write([&](const pool::Population& population, const auto& state) {
    kept = population;
    for (std::size_t k = 0; k < population.ids.size(); ++k) states.push_back(state(k));
  });
  CHECK(kept.ids.size() == 6);
  const auto read_into = [&](pool::Pool& pool) {
    pool.read([&](const auto& take) {
      for (const Bytes& each : states) take(each);
      return kept;
    });
  };
  for (const int ranks : {1, 2, 4, 9}) {
    const auto second = over(ranks, one_thread());
    std::string torn = refusal([&] {
      second->read([&](const auto& take) {
        take(states[0]);
        take(std::span(states[1]).first(100));
        return kept;
      });
    });
    CHECK(torn.find("snapshot") != std::string::npos);
    CHECK(second->ids().empty());
    read_into(*second);
    CHECK(second->ids() == kept.ids);
    for (std::size_t k = 0; k < kept.ids.size(); ++k) CHECK(second->at<&pool::Share::save>(kept.ids[k]) == states[k]);
    pool::ThreadedPool one(one_thread());
    read_into(one);
    const auto gradients = draw.gradients(6, 1e-4);
    CHECK(trial(one, kept.ids, gradients) == trial(*second, kept.ids, gradients));
    std::int64_t made = 0;
    second->spawn(second->add_template(packed(4)), 1, &made);  // into the slot that is free
    CHECK(pool::Id::of(made).slot == pool::Id::of(ids[2]).slot);
    CHECK(pool::Id::of(made).generation > pool::Id::of(ids[2]).generation);
  }
}

TEST_CASE("work over ranks is balanced to a tenth of the mean, none moved twice, and stays where it is balanced") {
  Draw draw(7);
  for (int round = 0; round < 200; ++round) {
    const int ranks = 2 + int(draw.below(7));
    const std::size_t n = 20 * std::size_t(ranks) + draw.below(200);
    std::vector<double> cost(n);
    std::vector<int> rank(n);
    for (std::size_t k = 0; k < n; ++k) {
      cost[k] = std::exp(draw.uniform());  // a factor of seven between them
      rank[k] = int(draw.below(std::size_t(ranks)));
    }
    const auto work_of = [&] {
      std::vector<double> work(std::size_t(ranks), 0.0);
      for (std::size_t k = 0; k < n; ++k) work[std::size_t(rank[k])] += cost[k];
      return work;
    };
    const auto imbalance = [&] {
      const std::vector<double> work = work_of();
      return *std::max_element(work.begin(), work.end()) * ranks / std::accumulate(work.begin(), work.end(), 0.0) - 1;
    };
    const double before = imbalance();
    const std::vector<Move> moves = moves_to_balance(cost, rank, ranks, 0.1);
    if (before <= 0.1) {
      CHECK(moves.empty());
      continue;
    }
    std::vector<int> times(n, 0);
    for (const Move& each : moves) {
      CHECK(rank[each.index] == each.from);
      CHECK(++times[each.index] == 1);
      rank[each.index] = each.to;
    }
    CHECK(imbalance() < 0.1);
    CHECK(moves.size() < n / 2);
  }
  // Nothing helps: one RVE on each of two ranks, one of them dear.
  CHECK(moves_to_balance(std::vector{1.0, 9.0}, std::vector{0, 1}, 2, 0.1).empty());
  CHECK(moves_to_balance(std::vector{0.0, 0.0, 0.0}, std::vector{0, 0, 0}, 2, 0.1).empty());
}
