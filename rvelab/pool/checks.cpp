#include "rvelab/pool/checks.hpp"

#include <cmath>
#include <string>

#include "rvelab/pool/status.hpp"

namespace rvelab::pool {

void expect_time(double dt) {
  constexpr double shortest = 1e-30;  // s, as in Rve
  if (dt == 0 || (dt >= shortest && std::isfinite(dt))) return;
  throw Refused(Status::bad_input,
                "dt is " + rvelab::in_words(dt) + " s; allowed: 0 (quasi-static) or a time of at least 1e-30 s");
}

void expect_spawn(std::int64_t n) {
  if (n < 0) throw Refused(Status::bad_input, "spawn: n is " + std::to_string(n) + "; allowed: 0 or more");
  if (n > std::int64_t(slot_limit)) throw Refused(Status::no_slot, "spawn: a pool has 2^26 slots at most");
}

void expect_whole(const Population& population, std::size_t states) {
  const auto expect = [](bool holds, const std::string& what) {
    if (!holds) throw Refused(Status::bad_file, "pool file: " + what + "; it was damaged: write it again");
  };
  expect(states == population.ids.size(),
         "it has " + std::to_string(population.ids.size()) + " ids for " + std::to_string(states) + " RVEs");
  expect(population.tag < tag_limit && (population.tag > 0 || states == 0), "its pool tag cannot be");
  expect(population.generations.size() <= slot_limit, "it has more slots than a pool");
  for (const std::uint32_t generation : population.generations)
    expect(generation >= 1 && generation <= generation_limit, "a generation of its slots cannot be");
  std::int64_t last = 0;
  for (const std::int64_t value : population.ids) {
    const Id id = Id::of(value);
    expect(value > 0 && id.value() == value && id.tag == population.tag && is_usable(id.slot) &&
               id.slot < population.generations.size() && id.generation == population.generations[id.slot] &&
               std::int64_t(id.slot) > last,
           "its id " + std::to_string(value) + " cannot be");
    last = id.slot;
  }
}

void expect_empty(const IdTable& ids) {
  if (ids.population() > 0)
    throw Refused(Status::bad_input, "pool_read: this pool has " + std::to_string(ids.population()) +
                                         " RVEs; read into a new pool, or release them first");
}

}  // namespace rvelab::pool
