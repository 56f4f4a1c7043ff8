// States of RVEs out of the pool and into it. Declared in threaded_pool.hpp.
#include <algorithm>
#include <string>
#include <utility>

#include "rvelab/pool/checks.hpp"
#include "rvelab/pool/hold.hpp"
#include "rvelab/pool/rve_state.hpp"
#include "rvelab/pool/threaded_pool.hpp"

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
  resident->rve.release();
  return resident;
}

}  // namespace

std::vector<std::byte> ThreadedPool::save(std::int64_t id) {
  const AtWork working(*this);
  const Hold hold = held(id, ++serial_);
  return bytes_of(hold.resident());
}

void ThreadedPool::load(std::int64_t id, std::span<const std::byte> snapshot) {
  const AtWork working(*this);
  const Hold hold = held(id, ++serial_);
  std::unique_ptr<Resident> read = opened(rve_state_of(snapshot));
  hold.slot().allocated.store(false, std::memory_order_relaxed);
  std::swap(hold.slot().resident, read);
}

void ThreadedPool::write(const std::function<void(const Population&, const StateOf&)>& writer) {
  const Alone alone(*this);
  Population population{slots_.ids().tag(), slots_.ids().generations(), {}};
  for (std::size_t k = 0; k < slots_.size(); ++k)
    if (slots_[k].resident) population.ids.push_back(slots_.ids().id_of(k));
  writer(population, [&](std::size_t k) { return bytes_of(*slots_.at(population.ids[k]).resident); });
}

void ThreadedPool::read(const std::function<Population(const TakeState& take)>& reader) {
  const Alone alone(*this);
  expect_empty(slots_.ids());
  Slots::Residents states;
  const Population population =
      reader([&](std::span<const std::byte> bytes) { states.push_back(opened(rve_state_of(bytes))); });
  expect_whole(population, states.size());
  slots_.restore(population.tag, population.generations, population.ids, std::move(states));
}

void ThreadedPool::receive(std::span<const std::byte> state, bool pending) {
  const Alone alone(*this);
  received_.push_back(opened(rve_state_of(state)));
  received_.back()->pending = pending && received_.back()->tokens.trials() > 0;
}

void ThreadedPool::place(std::span<const std::int64_t> ids) {
  const Alone alone(*this);
  slots_.claim(ids, std::move(received_));
  received_.clear();
}

void ThreadedPool::forget_received() noexcept { received_.clear(); }

}  // namespace rvelab::pool
