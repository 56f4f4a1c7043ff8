#include "rvelab/solver/loading/trial.hpp"

#include <utility>

namespace rvelab {

void Trial::begin(Assembly& a) {
  cell_ = a.cell;
  rows_ = a.rows;
  mass_ = a.mass;
  inverse_mass_ = a.inverse_mass;
  inverse_inertia_ = a.inverse_inertia;
  for (int k = 0; k < 3; ++k) {
    tangential_[k] = a.pairs.tangential[k];
    moment_[k] = a.pairs.moment[k];
  }
  root_overlap_ = a.pairs.root_overlap;
  force_ = a.pairs.force;
  touched_ = a.pairs.touched;
  state_ = a.state;
  replaced_.taken = false;
  a.replaced = &replaced_;
  pending_ = true;
  list_is_whole_ = false;
}

void Trial::end(Assembly& a) noexcept {
  a.replaced = nullptr;
  pending_ = false;
  // A list is made anew every few hundred sub-steps: its arrays are not worth keeping (350 bytes a grain).
  if (replaced_.taken) replaced_.list = PairTable();
}

void Trial::exchange(Assembly& a) noexcept {
  std::swap(a.cell, cell_);
  a.rows.swap(rows_);
  a.mass.swap(mass_);
  a.inverse_mass.swap(inverse_mass_);
  a.inverse_inertia.swap(inverse_inertia_);
  std::swap(a.state, state_);
  if (replaced_.taken) std::swap(a.pairs, replaced_.list);
  if (list_is_whole_) return;
  list_is_whole_ = replaced_.taken;
  for (int k = 0; k < 3; ++k) {
    a.pairs.tangential[k].swap(tangential_[k]);
    a.pairs.moment[k].swap(moment_[k]);
  }
  a.pairs.root_overlap.swap(root_overlap_);
  a.pairs.force.swap(force_);
  a.pairs.touched.swap(touched_);
}

std::size_t Trial::bytes() const {
  std::size_t sum = touched_.capacity() + bytes_of(replaced_.list);
  for (const Buffer* b : {&rows_, &mass_, &inverse_mass_, &inverse_inertia_, &root_overlap_, &force_, &tangential_[0],
                          &tangential_[1], &tangential_[2], &moment_[0], &moment_[1], &moment_[2]})
    sum += b->capacity() * sizeof(double);
  return sum + state_.list_positions.capacity() * sizeof(Vector3) +
         state_.memory_order.capacity() * sizeof(std::int32_t);
}

}  // namespace rvelab
