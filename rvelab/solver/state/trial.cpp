#include "rvelab/solver/state/trial.hpp"

#include <algorithm>
#include <utility>

namespace rvelab {

void Trial::begin(Assembly& assembly, Changes changes) {
  changes_ = changes;
  cell_ = assembly.cell;
  deferred_stretch_ = assembly.state.control.deferred.stretch;
  if (changes == Changes::deferred_strain) {
    pending_ = true;
    return;
  }
  rows_ = assembly.rows;
  bodies_ = assembly.bodies;
  for (int k = 0; k < 3; ++k) {
    tangential_[k] = assembly.pairs.tangential[k];
    moment_[k] = assembly.pairs.moment[k];
  }
  root_overlap_ = assembly.pairs.root_overlap;
  interactions_.resize(assembly.pairs.interactions.size());
  for (std::size_t t = 0; t < interactions_.size(); ++t) interactions_[t] = assembly.pairs.interactions[t].column;
  std::vector<Vector3> positions;
  positions.swap(assembly.state.list.positions);
  try {
    state_ = assembly.state;
  } catch (...) {  // no memory: nothing has begun
    positions.swap(assembly.state.list.positions);
    throw;
  }
  positions.swap(assembly.state.list.positions);
  replaced_.list_taken = replaced_.masses_taken = false;
  assembly.trial.replaced = &replaced_;
  pending_ = true;
  list_is_whole_ = false;
}

void Trial::end(Assembly& assembly) noexcept {
  assembly.trial.replaced = nullptr;
  pending_ = false;
  // A list is made again every few hundred sub-steps: its arrays are not worth keeping (350 bytes a grain).
  if (replaced_.list_taken) {
    replaced_.list = PairTable();
    replaced_.list_positions = {};
  }
}

void Trial::exchange(Assembly& assembly) noexcept {
  std::swap(assembly.cell, cell_);
  if (changes_ == Changes::deferred_strain) {
    std::swap(assembly.state.control.deferred.stretch, deferred_stretch_);
    return;
  }
  assembly.rows.swap(rows_);
  std::swap(assembly.bodies, bodies_);
  std::swap(assembly.state, state_);
  std::swap(assembly.state.list.positions, state_.list.positions);
  if (replaced_.masses_taken) {
    assembly.mass.swap(replaced_.mass);
    assembly.inverse_mass.swap(replaced_.inverse_mass);
    assembly.inverse_inertia.swap(replaced_.inverse_inertia);
  }
  if (replaced_.list_taken) {
    std::swap(assembly.pairs, replaced_.list);
    std::swap(assembly.state.list.positions, replaced_.list_positions);
  }
  if (!list_is_whole_) {
    list_is_whole_ = replaced_.list_taken;
    for (int k = 0; k < 3; ++k) {
      assembly.pairs.tangential[k].swap(tangential_[k]);
      assembly.pairs.moment[k].swap(moment_[k]);
    }
    assembly.pairs.root_overlap.swap(root_overlap_);
    for (std::size_t t = 0; t < interactions_.size(); ++t) assembly.pairs.interactions[t].column.swap(interactions_[t]);
  }
}

void evaluate_forces_again(const Model& model, Assembly& assembly) noexcept {
  std::fill(assembly.pairs.touched.begin(), assembly.pairs.touched.end(), 1);
  evaluate_forces(model, assembly);
}

std::size_t Trial::bytes() const {
  std::size_t sum = bytes_of(replaced_.list);
  for (const Buffer* b : {&rows_, &replaced_.mass, &replaced_.inverse_mass, &replaced_.inverse_inertia, &root_overlap_,
                          &tangential_[0], &tangential_[1], &tangential_[2], &moment_[0], &moment_[1], &moment_[2]})
    sum += b->capacity() * sizeof(double);
  for (const std::vector<Buffer>& columns : interactions_)
    for (const Buffer& b : columns) sum += b.capacity() * sizeof(double);
  sum += bytes_of(bodies_);
  return sum + (state_.list.positions.capacity() + replaced_.list_positions.capacity()) * sizeof(Vector3) +
         state_.memory_order.capacity() * sizeof(std::int32_t);
}

}  // namespace rvelab
