#include "rvelab/ranks/ranked_pool.hpp"

#include <algorithm>
#include <exception>
#include <string>
#include <utility>

#include "rvelab/solver/snapshot.hpp"

namespace rvelab::ranks {

using pool::Refused;
using pool::Status;

RankedPool::RankedPool(std::unique_ptr<Link> link, std::unique_ptr<pool::Share> own)
    : link_(std::move(link)), own_(std::move(own)), population_(std::size_t(link_->ranks()), 0) {}

RankedPool::~RankedPool() {
  constexpr RankCall end = RankCall::end;
  for (int rank = 1; rank < link_->ranks(); ++rank) try {
      link_->send(rank, std::as_bytes(std::span(&end, 1)));
    } catch (...) {  // that rank is gone
    }
}

void RankedPool::expect_this_process() const {
  link_->expect_thread();
  own_.share().expect_this_process();
}

RankedPool::Lock RankedPool::at_work() {
  Lock lock(mutex_);
  expect_this_process();
  if (broken_)
    throw Refused(Status::internal,
                  "pool: a message between ranks was lost, and RVEs with it; destroy the pool and "
                  "read the last pool file into a new one");
  return lock;
}

RankedPool::Lock RankedPool::alone() {
  if (Lock now(mutex_, std::try_to_lock); !now.owns_lock())
    throw Refused(Status::busy, "pool: another call is under way; population and files are for one call alone");
  return at_work();
}

void RankedPool::close() {
  Lock now(mutex_, std::try_to_lock);
  if (!now.owns_lock())
    throw Refused(Status::busy, "pool_destroy: a call is under way; destroy the pool after it has returned");
  expect_this_process();
  own_.share().close();
}

/// What an exchange asks for, so that it can be asked for before.
struct RankedPool::Room {
  Answers answers;
  Messages received;  ///< by rank
  std::vector<int> asked;

  explicit Room(std::size_t ranks, std::size_t bytes = 0) : received(ranks) {
    answers.reserve(ranks);
    asked.reserve(ranks);
    for (Bytes& each : received) each.reserve(bytes);
  }
};

RankedPool::Answers RankedPool::exchange(const Messages& messages) { return exchange(messages, Room(messages.size())); }

/// Sends each rank its message and works on that of the first meanwhile. The answers, by rank. All are taken whatever
/// goes wrong, so that the next exchange begins anew.
RankedPool::Answers RankedPool::exchange(const Messages& messages, Room room) {
  std::exception_ptr failure;
  const auto guarded = [&](const auto& step) {
    try {
      step();
    } catch (...) {
      broken_ = true;  // what a rank has done is not known here
      if (!failure) failure = std::current_exception();
    }
  };
  for (int rank = 1; rank < link_->ranks(); ++rank)
    if (!messages[std::size_t(rank)].empty())
      guarded([&] {
        link_->send(rank, messages[std::size_t(rank)]);
        room.asked.push_back(rank);
      });
  if (!messages[0].empty()) room.answers.emplace_back(0, Answer(own_.answer(messages[0])));
  for (const int rank : room.asked)
    guarded([&] {
      Bytes& received = room.received[std::size_t(rank)];
      link_->receive(rank, received);
      room.answers.emplace_back(rank, Answer(std::move(received)));
    });
  if (failure) std::rethrow_exception(failure);
  return std::move(room.answers);
}

/// Refused as the first rank that refused was.
void RankedPool::expect_all_done(const Messages& messages) {
  for (const auto& [rank, answer] : exchange(messages)) answer.expect_done();
}

/// The same of one rank; asks for no memory here.
Answer RankedPool::answer_of(int rank, const Bytes& bytes) {
  if (rank == 0) return Answer(own_.answer(bytes));
  try {
    link_->send(rank, bytes);
    Bytes received;
    link_->receive(rank, received);
    return Answer(std::move(received));
  } catch (...) {
    broken_ = true;
    throw;
  }
}

Answer RankedPool::ask(int rank, const Bytes& bytes) {
  Answer answer = answer_of(rank, bytes);
  answer.expect_done();
  return answer;
}

/// Indices into `ids` for each rank. Refused (bad_id, duplicate).
std::vector<std::vector<std::size_t>> RankedPool::by_rank(std::span<const std::int64_t> ids) {
  std::vector<std::vector<std::size_t>> found(population_.size());
  ++call_;
  for (std::size_t k = 0; k < ids.size(); ++k) {
    Place& place = place_of(ids[k]);
    if (std::exchange(place.call, call_) == call_)
      throw Refused(Status::duplicate,
                    "id " + std::to_string(ids[k]) + " stands twice in one call; give each RVE once");
    found[std::size_t(place.rank)].push_back(k);
  }
  return found;
}

/// For each rank that has some of the ids; trials of `ids` without data: for all ranks, all of each.
RankedPool::Messages RankedPool::to_prepare(pool::Settling what, std::span<const std::int64_t> ids) {
  Messages messages = no_messages();
  const bool all = ids.data() == nullptr && what != pool::Settling::give_up;
  const auto indices = by_rank(ids);
  for (std::size_t rank = 0; rank < messages.size(); ++rank) {
    if (!all && indices[rank].empty()) continue;
    std::vector<std::int64_t> own, places;
    for (const std::size_t k : indices[rank]) {
      own.push_back(ids[k]);
      places.push_back(std::int64_t(k));
    }
    const std::span<const std::int64_t> of = all ? std::span<const std::int64_t>() : std::span(own);
    messages[rank] = message<&pool::Share::prepare>(what, of, places);
  }
  return messages;
}

/// All ranks do it or none: first each says that it can, then each does it, and neither it nor the first rank asks for
/// memory.
void RankedPool::settle(pool::Settling what, std::span<const std::int64_t> ids) {
  const Messages first = to_prepare(what, ids);
  Messages then(first.size(), message<&pool::Share::settle>());
  for (std::size_t rank = 0; rank < first.size(); ++rank)
    if (first[rank].empty()) then[rank].clear();
  Room room(first.size(), answer_room);
  expect_all_done(first);
  exchange(then, std::move(room));
}

RankedPool::Messages RankedPool::to_others(const Bytes& message) const {
  Messages messages(population_.size(), message);
  messages[0].clear();
  return messages;
}

void RankedPool::make_at(std::int64_t id, pool::TravellingCall& call) {
  const Lock lock = at_work();
  const int rank = place_of(id).rank;
  Packer packer;
  call.put(packer);
  Answer answer = ask(rank, packer.take());
  call.take_result(answer.found());
}

void RankedPool::make_everywhere(pool::TravellingCall& call) {
  const Lock lock = alone();
  Packer packer;
  call.put(packer);
  const Bytes message = packer.take();
  for (const auto& [rank, answer] : exchange(to_others(message)))
    if (answer.status() != Status::bad_id) answer.expect_done();
  Answer answer = ask(0, message);
  call.take_result(answer.found());
}

std::int64_t RankedPool::add_template(Specimen specimen) {
  const Lock lock = alone();
  const std::int64_t number = own_.share().add_template(specimen);
  try {
    expect_all_done(to_others(message<&pool::Share::add_template_as>(specimen, number, own_.share().first_token())));
  } catch (...) {
    own_.share().release_template(number);
    exchange(to_others(message<&pool::Share::release_template>(number)));
    throw;
  }
  return number;
}

void RankedPool::make_room(std::size_t n) {
  // Tags are given out by librvelab.so: each library has a table of its own.
  if (ids_.tag() == 0) ids_.go_on_as(own_.share().first_id());
  ids_.make_room(n);
  places_.resize(std::max(places_.size(), ids_.size()));
}

void RankedPool::spawn(std::int64_t of_template, std::int64_t n, std::int64_t* ids) {
  const Lock lock = alone();
  pool::expect_spawn(n);
  const auto spawned = [&](std::span<const std::int64_t> of) {
    return message<&pool::Share::spawn_as>(of_template, of);
  };
  ask(0, spawned({}));  // refused if there is no such template
  if (n == 0) return;
  make_room(std::size_t(n));
  std::vector<std::size_t> filled = population_;
  std::vector<std::vector<std::int64_t>> of_rank(filled.size());
  std::vector<std::int64_t> taken;
  taken.reserve(std::size_t(n));
  try {
    while (std::int64_t(taken.size()) < n) {  // to the rank that has fewest
      const auto rank = std::size_t(std::min_element(filled.begin(), filled.end()) - filled.begin());
      ++filled[rank];
      taken.push_back(ids_.take());
      places_[pool::Id::of(taken.back()).slot] = Place{int(rank)};
      of_rank[rank].push_back(taken.back());
    }
    Messages messages = no_messages(), undo = no_messages();
    for (std::size_t rank = 0; rank < messages.size(); ++rank)
      if (!of_rank[rank].empty()) messages[rank] = spawned(of_rank[rank]);
    std::vector<std::pair<int, Answer>> answers = exchange(messages);
    const auto failed = std::find_if(answers.begin(), answers.end(), [](auto& each) { return each.second.failed(); });
    if (failed != answers.end()) {
      for (const auto& [rank, answer] : answers)
        if (!answer.failed()) undo[std::size_t(rank)] = message<&pool::Share::give_up>(of_rank[std::size_t(rank)]);
      exchange(undo);
      failed->second.expect_done();
    }
  } catch (...) {
    for (const std::int64_t id : taken) ids_.give_back(id);
    throw;
  }
  population_ = filled;
  std::copy(taken.begin(), taken.end(), ids);
}

std::int64_t RankedPool::clone(std::int64_t source) {
  const Lock lock = alone();
  const Place& original = place_of(source);
  const int rank = original.rank;
  make_room(1);
  const std::int64_t id = ids_.take();
  try {
    ask(rank, message<&pool::Share::clone_as>(source, id));
  } catch (...) {
    ids_.give_back(id);
    throw;
  }
  places_[pool::Id::of(id).slot] = Place{rank};
  ++population_[std::size_t(rank)];
  return id;
}

void RankedPool::release(std::span<const std::int64_t> ids) {
  const Lock lock = alone();
  settle(pool::Settling::give_up, ids);
  for (const std::int64_t id : ids) {
    --population_[std::size_t(place_of(id).rank)];
    ids_.give_back(id);
  }
}

std::vector<std::int64_t> RankedPool::ids() {
  const Lock lock = alone();
  return ids_.all();
}

/// One call travels at a time.
void RankedPool::run_each(std::size_t count, const std::function<void(std::size_t)>& piece) {
  for (std::size_t k = 0; k < count; ++k) piece(k);
}

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
  return ask(rank, message<&pool::Share::costs>(ids)).found().take_all<std::int64_t>();
}

void RankedPool::write(const std::function<void(const pool::Population&, const StateOf&)>& writer) {
  const Lock lock = alone();
  const pool::Population population{ids_.tag(), ids_.generations(), ids_.all()};
  writer(population, [&](std::size_t k) {
    const std::int64_t id = population.ids[k];
    return ask(place_of(id).rank, message<&pool::Share::save>(id)).found().take_all<std::byte>();
  });
}

/// Each state goes to the next rank as it comes, so that no rank holds more than its share.
void RankedPool::read(const std::function<pool::Population(const TakeState& take)>& reader) {
  const Lock lock = alone();
  pool::expect_empty(ids_.population());
  const std::size_t ranks = population_.size();
  std::size_t states = 0;
  try {
    const pool::Population population = reader([&](std::span<const std::byte> bytes) {
      ask(int(states++ % ranks), message<&pool::Share::receive>(Packer().put(false).put_all(bytes).take()));
    });
    pool::expect_whole(population, states);
    std::vector<Place> places(population.generations.size());
    std::vector<std::vector<std::int64_t>> of_rank(ranks);
    for (std::size_t k = 0; k < states; ++k) {
      places[pool::Id::of(population.ids[k]).slot].rank = int(k % ranks);
      of_rank[k % ranks].push_back(population.ids[k]);
    }
    ids_.go_on_as(own_.share().first_id());
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
