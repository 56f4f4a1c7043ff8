// Costs and states of RVEs on other ranks, and files of the whole pool. Declared in ranked_pool.hpp.
#include <new>
#include <utility>

#include "rvelab/pool/checks.hpp"
#include "rvelab/ranks/ranked_pool.hpp"

namespace rvelab::ranks {

void RankedPool::cost(std::span<const std::int64_t> ids, std::int64_t* grain_steps) {
  const Lock lock = at_work();
  for (const std::int64_t id : ids) ids_.slot_of(id);
  std::vector<std::vector<std::int64_t>> of_rank(population_.size());
  std::vector<std::vector<std::size_t>> entries(population_.size());
  for (std::size_t k = 0; k < ids.size(); ++k) {
    const auto rank = std::size_t(place_of(ids[k]).rank);
    of_rank[rank].push_back(ids[k]);
    entries[rank].push_back(k);
  }
  for (std::size_t rank = 0; rank < of_rank.size(); ++rank) {
    if (of_rank[rank].empty()) continue;
    const std::vector<std::int64_t> costs = costs_at(int(rank), of_rank[rank]);
    for (std::size_t k = 0; k < costs.size(); ++k)
      grain_steps[entries[rank][k]] = place_of(of_rank[rank][k]).cost_before + costs[k];
  }
}

/// What RVEs cost since they came to that rank, where they are. A commit that made a trial again is in it.
std::vector<std::int64_t> RankedPool::costs_at(int rank, std::span<const std::int64_t> ids) {
  return ask(rank, message(RankCall::cost).put_all(ids).take()).found().take_all<std::int64_t>();
}

Bytes RankedPool::saved(std::int64_t id) {
  Answer answer = ask(place_of(id).rank, message<&pool::Share::save>(id));
  return answer.found().take_all<std::byte>();
}

void RankedPool::write(const std::function<void(const pool::Population&, const StateOf&)>& writer) {
  const Lock lock = alone();
  pool::Population population{ids_.tag(), ids_.generations(), {}};
  for (std::size_t slot = 0; slot < ids_.size(); ++slot)
    if (ids_.in_use(slot)) population.ids.push_back(ids_.id_of(slot));
  writer(population, [&](std::size_t k) { return saved(population.ids[k]); });
}

/// Each state goes to the next rank as it comes, so that no rank holds more than its share.
void RankedPool::read(const std::function<pool::Population(const TakeState& take)>& reader) {
  const Lock lock = alone();
  pool::expect_empty(ids_);
  const std::size_t ranks = population_.size();
  std::size_t states = 0;
  try {
    const pool::Population population = reader([&](std::span<const std::byte> bytes) {
      ask(int(states % ranks), message(RankCall::receive).put(false).put_all(bytes).take());
      ++states;
    });
    pool::expect_whole(population, states);
    std::vector<Place> places(population.generations.size());
    std::vector<std::vector<std::int64_t>> of_rank(ranks);
    for (std::size_t k = 0; k < states; ++k) {
      places[pool::Id::of(population.ids[k]).slot].rank = int(k % ranks);
      of_rank[k % ranks].push_back(population.ids[k]);
    }
    Messages messages = no_messages();
    for (std::size_t rank = 0; rank < ranks; ++rank) messages[rank] = message<&pool::Share::place>(of_rank[rank]);
    expect_all_done(messages);
    ids_.restore(population.tag, population.generations, population.ids);
    places_ = std::move(places);
    for (std::size_t rank = 0; rank < ranks; ++rank) population_[rank] = of_rank[rank].size();
  } catch (...) {
    expect_all_done(Messages(ranks, message<&pool::Share::forget_received>()));
    throw;
  }
}

void serve(Link& link, std::unique_ptr<pool::Share> share) {
  Served served(std::move(share));
  Bytes message;
  while (true) {
    try {
      link.receive(0, message);
    } catch (const std::bad_alloc&) {
      link.send(0, {});  // as an answer that could not be made
      continue;
    }
    const auto number = Unpacker(message).take<std::int32_t>();
    if (number == std::int32_t(RankCall::end)) return;
    link.send(0, served.answer(message));
    if (number != ShareCalls::number<&pool::Share::prepare>())
      message = Bytes();  // its room is that of the message to settle
  }
}

}  // namespace rvelab::ranks
