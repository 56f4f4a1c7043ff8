// What is measured of the RVEs of a pool. Declared in threaded_pool.hpp.
#include "rvelab/measure/measures.hpp"
#include "rvelab/pool/hold.hpp"
#include "rvelab/pool/threaded_pool.hpp"

namespace rvelab::pool {

namespace {

/// Kozeny-Carman: the permeability goes with e^3/(1 + e).
double permeability(double void_ratio) { return void_ratio * void_ratio * void_ratio / (1 + void_ratio); }

}  // namespace

Info ThreadedPool::info(std::int64_t id) {
  const AtWork working(*this);
  const Hold hold = held(id, ++serial_);
  Resident& resident = hold.resident();
  Info info;
  info.memory = resident.rve.memory();
  if (!resident.pending) info.memory.trial = 0;
  info.token = resident.tokens.committed();
  info.inertial_number = resident.inertial_number;
  const Committed committed(resident.rve);
  const Network network = resident.rve.network();
  const Matrix3 stress = resident.rve.stress();
  const int dimension = network.dimension();
  info.cell = network.cell;
  info.grains = network.grains.size();
  info.contacts = network.contacts.size();
  info.void_ratio = void_ratio(network);
  info.coordination_number = coordination_number(network);
  info.fabric = fabric(network);
  info.fabric_anisotropy = fabric_anisotropy(info.fabric, dimension);
  info.sliding_fraction = sliding_fraction(network);
  info.p = mean_pressure(stress, dimension);
  info.q = deviatoric_stress(stress, dimension);
  info.unbalanced_force_ratio = resident.rve.unbalanced_ratio();
  info.permeability_ratio = permeability(info.void_ratio) / permeability(resident.initial_void_ratio);
  info.min_height_ratio = heights(network.cell).minCoeff() / mean_diameter(network);
  info.grain_steps = resident.rve.grain_steps();
  return info;
}

void ThreadedPool::cost(std::span<const std::int64_t> ids, std::int64_t* grain_steps) {
  const AtWork working(*this);
  for (const std::int64_t id : ids) slots_.at(id);
  for (const std::int64_t id : ids)
    *grain_steps++ = std::int64_t(slots_.at(id).grain_steps.load(std::memory_order_relaxed));
}

}  // namespace rvelab::pool
