#include "rvelab/solver/state/trial.hpp"

#include <algorithm>
#include <utility>

namespace rvelab {

void Trial::begin(Assembly& a, Changes changes) {
  changes_ = changes;
  cell_ = a.cell;
  deferred_stretch_ = a.state.deferred_stretch;
  if (changes == Changes::deferred_strain) {
    pending_ = true;
    return;
  }
  rows_ = a.rows;
  for (int k = 0; k < 3; ++k) {
    tangential_[k] = a.pairs.tangential[k];
    moment_[k] = a.pairs.moment[k];
  }
  root_overlap_ = a.pairs.root_overlap;
  std::vector<Vector3> positions;
  positions.swap(a.state.list_positions);
  try {
    state_ = a.state;
  } catch (...) {  // no memory: nothing has begun
    positions.swap(a.state.list_positions);
    throw;
  }
  positions.swap(a.state.list_positions);
  replaced_.list_taken = replaced_.masses_taken = false;
  a.trial.replaced = &replaced_;
  pending_ = true;
  list_is_whole_ = false;
}

void Trial::end(Assembly& a) noexcept {
  a.trial.replaced = nullptr;
  pending_ = false;
  // A list is made anew every few hundred sub-steps: its arrays are not worth keeping (350 bytes a grain).
  if (replaced_.list_taken) {
    replaced_.list = PairTable();
    replaced_.list_positions = {};
  }
}

void Trial::exchange(const Model& f, Assembly& a, bool released) noexcept {
  std::swap(a.cell, cell_);
  if (changes_ == Changes::deferred_strain) {
    std::swap(a.state.deferred_stretch, deferred_stretch_);
    return;
  }
  a.rows.swap(rows_);
  std::swap(a.state, state_);
  std::swap(a.state.list_positions, state_.list_positions);
  if (replaced_.masses_taken) {
    a.mass.swap(replaced_.mass);
    a.inverse_mass.swap(replaced_.inverse_mass);
    a.inverse_inertia.swap(replaced_.inverse_inertia);
  }
  if (replaced_.list_taken) {
    std::swap(a.pairs, replaced_.list);
    std::swap(a.state.list_positions, replaced_.list_positions);
  }
  if (!list_is_whole_) {
    list_is_whole_ = replaced_.list_taken;
    for (int k = 0; k < 3; ++k) {
      a.pairs.tangential[k].swap(tangential_[k]);
      a.pairs.moment[k].swap(moment_[k]);
    }
    a.pairs.root_overlap.swap(root_overlap_);
  }
  if (released) return;
  std::fill(a.pairs.touched.begin(), a.pairs.touched.end(), 1);  // by the other state: nothing is passed over
  evaluate_forces(f, a);
}

std::size_t Trial::bytes() const {
  std::size_t sum = bytes_of(replaced_.list);
  for (const Buffer* b : {&rows_, &replaced_.mass, &replaced_.inverse_mass, &replaced_.inverse_inertia, &root_overlap_,
                          &tangential_[0], &tangential_[1], &tangential_[2], &moment_[0], &moment_[1], &moment_[2]})
    sum += b->capacity() * sizeof(double);
  return sum + (state_.list_positions.capacity() + replaced_.list_positions.capacity()) * sizeof(Vector3) +
         state_.memory_order.capacity() * sizeof(std::int32_t);
}

}  // namespace rvelab
