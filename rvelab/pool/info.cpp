// Measures and costs of the RVEs of a pool. Declared in threaded_pool.hpp.
#include "rvelab/measure/measures.hpp"
#include "rvelab/pool/hold.hpp"
#include "rvelab/pool/threaded_pool.hpp"

namespace rvelab::pool {

namespace {

/// Kozeny-Carman: the permeability goes with e^3/(1 + e).
double permeability(double void_ratio) { return void_ratio * void_ratio * void_ratio / (1 + void_ratio); }

std::array<double, 9> rows_of(const Matrix3& tensor) {
  std::array<double, 9> rows;
  for (int k = 0; k < 9; ++k) rows[std::size_t(k)] = tensor(k / 3, k % 3);
  return rows;
}

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
  info.dimension = dimension;
  info.lattice = rows_of(network.cell.lattice);
  info.rotation = rows_of(network.cell.rotation);
  info.volume = network.cell.volume();
  info.grains = network.grains.size();
  info.contacts = network.contacts.size();
  info.void_ratio = void_ratio(network);
  info.coordination_number = coordination_number(network);
  const Matrix3 fabric_tensor = fabric(network);
  info.fabric = rows_of(fabric_tensor);
  info.fabric_anisotropy = fabric_anisotropy(fabric_tensor, dimension);
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
