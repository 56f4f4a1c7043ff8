#include "rvelab/pool/pool.hpp"

#include <cmath>
#include <string>

#include "rvelab/pool/slots.hpp"

namespace rvelab::pool {

void expect_options(const Options& options) {
  if (options.workers < 0)
    throw Refused(Status::bad_input, "pool_def.workers is " + std::to_string(options.workers) +
                                         "; allowed: 1 or more, or 0 for as many as the processor runs at once");
  if (options.trial_memory != RVELAB_TRIAL_KEEP && options.trial_memory != RVELAB_TRIAL_RECOMPUTE)
    throw Refused(Status::unsupported, "pool_def.trial_memory is " + std::to_string(options.trial_memory) +
                                           "; allowed: RVELAB_TRIAL_KEEP (0), RVELAB_TRIAL_RECOMPUTE (1)");
  const auto expect = [](bool allowed, const char* name, double value, const char* range) {
    if (!allowed)
      throw Refused(Status::bad_input, std::string("pool_def.") + name + " is " + rvelab::in_words(value) +
                                           "; allowed: " + range + ", or 0 for what the specimen says");
  };
  const auto share = [](double value) { return value >= 0 && value <= 1; };
  expect(share(options.tolerance_rel), "tolerance_rel", options.tolerance_rel, "above 0, at most 1");
  expect(share(options.tolerance_abs), "tolerance_abs", options.tolerance_abs, "above 0, at most 1");
  expect(options.max_substeps >= 0, "max_substeps", double(options.max_substeps), "1 or more");
  expect(options.damping >= 0 && options.damping < 1, "damping", options.damping, "above 0 and below 1");
  expect(options.min_height >= 0 && std::isfinite(options.min_height), "min_height", options.min_height,
         "a positive length in m");
}

bool is_empty(const Batch& batch) {
  if (batch.n < 0) throw Refused(Status::bad_input, "batch.n is " + std::to_string(batch.n) + "; allowed: 0 or more");
  if (batch.n > 0) expect_time(batch.dt);
  return batch.n == 0;
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

void expect_empty(std::size_t population) {
  if (population > 0)
    throw Refused(Status::bad_input, "pool_read: this pool has " + std::to_string(population) +
                                         " RVEs; read into a new pool, or release them first");
}

}  // namespace rvelab::pool
