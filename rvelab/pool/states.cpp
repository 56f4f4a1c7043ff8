// Measures, costs and states of the RVEs of a pool. Declared in threaded_pool.hpp.
#include <utility>

#include "rvelab/measure/measures.hpp"
#include "rvelab/pool/arrays.hpp"
#include "rvelab/pool/threaded_pool.hpp"

namespace rvelab::pool {

namespace {

/// Kozeny-Carman: the permeability goes with e^3/(1 + e).
double permeability(double void_ratio) { return void_ratio * void_ratio * void_ratio / (1 + void_ratio); }

/// Of an RVE in its committed state.
std::vector<std::byte> bytes_of(const Resident& resident) {
  const RveState state{{}, resident.tokens, resident.initial_void_ratio, resident.last};
  return to_bytes(state, resident.rve.save());
}

}  // namespace

std::unique_ptr<Resident> ThreadedPool::opened(const RveState& state) const {
  auto resident =
      std::make_unique<Resident>(Resident{Rve(state.specimen), state.tokens, state.initial_void_ratio, state.last});
  resident->rve.watch(&interrupted_);
  resident->rve.release();
  return resident;
}

rvelab_info ThreadedPool::info(std::int64_t id) {
  const AtWork working(*this);
  const Hold hold = held(id, ++serial_);
  Resident& resident = hold.resident();
  rvelab_info info{};
  const Memory memory = resident.rve.memory();
  info.bytes_resting = std::int64_t(memory.state + memory.list);
  info.bytes_trial = resident.pending ? std::int64_t(memory.trial) : 0;
  info.bytes_working = std::int64_t(memory.working);
  info.token = resident.tokens.committed();
  info.inertial_number = resident.last.inertial_number;
  const Committed committed(resident.rve);
  const Network network = resident.rve.network();
  const Matrix3 stress = resident.rve.stress();
  const int dimension = network.dimension();
  info.dimension = dimension;
  store(network.cell.lattice, info.lattice);
  store(network.cell.rotation, info.rotation);
  info.volume = network.cell.volume();
  info.grains = std::int64_t(network.grains.size());
  info.contacts = std::int64_t(network.contacts.size());
  info.void_ratio = void_ratio(network);
  info.coordination_number = coordination_number(network);
  const Matrix3 fabric_tensor = fabric(network);
  store(fabric_tensor, info.fabric);
  info.fabric_anisotropy = fabric_anisotropy(fabric_tensor, dimension);
  info.sliding_fraction = sliding_fraction(network);
  info.p = mean_pressure(stress, dimension);
  info.q = deviatoric_stress(stress, dimension);
  info.unbalanced_force_ratio = resident.rve.unbalanced_ratio();
  info.permeability_ratio = permeability(info.void_ratio) / permeability(resident.initial_void_ratio);
  info.min_height_ratio = heights(network.cell).minCoeff() / mean_diameter(network);
  info.grain_steps = std::int64_t(resident.rve.grain_steps());
  store(stress, info.sigma);
  store(resident.rve.contact_stress(), info.contact);
  store(resident.rve.reynolds_stress(), info.reynolds);
  info.error_estimate = resident.last.error_estimate;
  return info;
}

std::vector<std::int64_t> ThreadedPool::array_rows(std::int64_t id) {
  return of_committed(id, [](const Resident& resident) { return pool::array_rows(resident.rve); });
}

std::vector<std::byte> ThreadedPool::array(std::int64_t id, std::int64_t k) {
  return of_committed(id, [&](const Resident& resident) { return array_of(resident.rve, std::size_t(k)); });
}

void ThreadedPool::cost(std::span<const std::int64_t> ids, std::int64_t* grain_steps) {
  const AtWork working(*this);
  for (const std::int64_t id : ids) slots_.at(id);
  for (const std::int64_t id : ids)
    *grain_steps++ = std::int64_t(slots_.at(id).grain_steps.load(std::memory_order_relaxed));
}

std::vector<std::byte> ThreadedPool::save(std::int64_t id) { return of_committed(id, bytes_of); }

void ThreadedPool::load(std::int64_t id, std::span<const std::byte> snapshot) {
  const AtWork working(*this);
  take_state(held(id, ++serial_), snapshot);
}

void ThreadedPool::replace(std::int64_t id, std::span<const std::byte> snapshot, std::int64_t token,
                           std::int64_t grain_steps) {
  const AtWork working(*this);
  const Hold hold = held(id, ++serial_);
  if (hold.resident().tokens.committed() != token)
    throw Refused(Status::busy, "another call has changed the RVE meanwhile; call again");
  take_state(hold, snapshot);
  hold.slot().grain_steps.fetch_add(std::uint64_t(grain_steps), std::memory_order_relaxed);
}

void ThreadedPool::take_state(const Hold& hold, std::span<const std::byte> snapshot) {
  std::unique_ptr<Resident> read = opened(rve_state_of(snapshot));
  hold.slot().allocated.store(false, std::memory_order_relaxed);
  std::swap(hold.slot().resident, read);
}

void ThreadedPool::write(const std::function<void(const Population&, const StateOf&)>& writer) {
  const Alone alone(*this);
  const Population population{slots_.tag(), slots_.generations(), slots_.all()};
  writer(population, [&](std::size_t k) {
    expect_not_interrupted();
    Resident& resident = *slots_.at(population.ids[k]).resident;
    const Committed committed(resident.rve);
    return bytes_of(resident);
  });
}

void ThreadedPool::read(const std::function<Population(const TakeState& take)>& reader) {
  const Alone alone(*this);
  expect_empty(slots_.population());
  Slots::Residents states;
  const Population population = reader([&](std::span<const std::byte> bytes) {
    expect_not_interrupted();
    states.push_back(opened(rve_state_of(bytes)));
  });
  expect_whole(population, states.size());
  slots_.restore(population.tag, population.generations, population.ids, std::move(states));
}

std::vector<std::byte> ThreadedPool::pack(std::span<const std::int64_t> ids) {
  const AtWork working(*this);
  Packer packed;
  for (const Hold& hold : held(ids, ++serial_)) {
    const Committed committed(hold.resident().rve);
    packed.put(hold.resident().pending).put_all(std::span<const std::byte>(bytes_of(hold.resident())));
  }
  return packed.take();
}

void ThreadedPool::receive(std::span<const std::byte> packed) {
  const Alone alone(*this);
  for (Unpacker in(packed); !in.rest().empty();) {
    const auto pending = in.take<bool>();
    received_.push_back(opened(rve_state_of(in.take_bytes())));
    received_.back()->pending = pending && received_.back()->tokens.trials() > 0;
  }
}

void ThreadedPool::place(std::span<const std::int64_t> ids) {
  const Alone alone(*this);
  slots_.claim(ids, std::move(received_));
  received_.clear();
}

void ThreadedPool::forget_received() noexcept { received_.clear(); }

}  // namespace rvelab::pool
