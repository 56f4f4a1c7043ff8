// States of RVEs out of the pool and into it. Declared in pool.hpp.
#include <algorithm>
#include <string>
#include <utility>

#include "rvelab/pool/hold.hpp"
#include "rvelab/pool/pool.hpp"

namespace rvelab::pool {

namespace {

std::vector<std::byte> bytes_of(Resident& resident) {
  const Committed committed(resident.rve);
  const RveState state{{}, resident.tokens, resident.initial_void_ratio, resident.inertial_number};
  return to_bytes(state, resident.rve.save());
}

std::unique_ptr<Resident> opened(const RveState& state) {
  auto resident = std::make_unique<Resident>(
      Resident{Rve(state.specimen), state.tokens, state.initial_void_ratio, state.inertial_number});
  resident->rve.rest();
  return resident;
}

void expect_population(const Population& population, std::size_t states) {
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

}  // namespace

std::vector<std::byte> Pool::save(std::int64_t id) {
  const AtWork working(*this);
  const Hold hold = held(id, ++serial_);
  return bytes_of(hold.resident());
}

void Pool::load(std::int64_t id, std::span<const std::byte> snapshot) {
  const AtWork working(*this);
  const Hold hold = held(id, ++serial_);
  std::unique_ptr<Resident> read = opened(rve_state_of(snapshot));
  hold.slot().awake.store(false, std::memory_order_relaxed);
  std::swap(hold.slot().resident, read);
}

void Pool::write(
    const std::function<void(const Population&, const std::function<std::vector<std::byte>(std::size_t)>&)>& writer) {
  const Alone alone(*this);
  Population population{slots_.tag(), slots_.generations(), {}};
  for (std::size_t k = 0; k < slots_.size(); ++k)
    if (slots_[k].resident) population.ids.push_back(slots_.id_of(k));
  writer(population, [&](std::size_t k) { return bytes_of(*slots_.at(population.ids[k]).resident); });
}

void Pool::read(const std::function<Population(const std::function<void(std::span<const std::byte>)>& take)>& reader) {
  const Alone alone(*this);
  if (slots_.population() > 0)
    throw Refused(Status::bad_input, "pool_read: this pool has " + std::to_string(slots_.population()) +
                                         " RVEs; read into a new pool, or release them first");
  std::vector<std::unique_ptr<Resident>> states;
  const Population population =
      reader([&](std::span<const std::byte> bytes) { states.push_back(opened(rve_state_of(bytes))); });
  expect_population(population, states.size());
  std::vector<std::pair<std::uint32_t, std::unique_ptr<Resident>>> residents;
  residents.reserve(states.size());
  for (std::size_t k = 0; k < states.size(); ++k)
    residents.emplace_back(Id::of(population.ids[k]).slot, std::move(states[k]));
  slots_.restore(population.tag, population.generations, std::move(residents));
}

}  // namespace rvelab::pool
