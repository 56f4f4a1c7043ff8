#include "rvelab/solver/state/trial_cache.hpp"

#include <new>
#include <utility>

#include "rvelab/solver/assembly/gather_table.hpp"

namespace rvelab {

namespace {

/// each(array) for what sub-steps change in a list that stays.
template <class Pairs, class Each>
void each_changed(Pairs& pairs, const Each& each) {
  for (int k = 0; k < 3; ++k) {
    each(pairs.tangential[k]);
    each(pairs.moment[k]);
  }
  each(pairs.root_overlap);
  each(pairs.force);
  each(pairs.resultants);
  for (auto& interactions : pairs.interactions)
    for (auto& column : interactions.column) each(column);
}

}  // namespace

void TrialCache::keep(const Assembly& assembly, const Matrix3& committed_lattice,
                      CachedRelaxation relaxation) noexcept {
  kept_ = false;
  const Replaced* replaced = assembly.trial.replaced;
  if (replaced == nullptr || !(assembly.cell.lattice.array() == committed_lattice.array()).all()) return;
  try {
    relaxation_ = std::move(relaxation);
    cell_ = assembly.cell;
    rows_ = assembly.rows;
    bodies_ = assembly.bodies;
    state_ = assembly.state;
    own_list_ = replaced->list_taken;
    if (own_list_) {
      list_ = assembly.pairs;
    } else {
      state_.list.positions = {};
      std::size_t k = 0;
      each_changed(assembly.pairs, [&](const Buffer& array) {
        if (k == changed_.size()) changed_.emplace_back();
        changed_[k++] = array;
      });
      touched_ = assembly.pairs.touched;
    }
    own_masses_ = replaced->masses_taken;
    if (own_masses_) {
      mass_ = assembly.mass;
      inverse_mass_ = assembly.inverse_mass;
      inverse_inertia_ = assembly.inverse_inertia;
    }
    kept_ = true;
  } catch (const std::bad_alloc&) {
    *this = TrialCache();
  }
}

void TrialCache::take_over(Assembly& assembly) const {
  Replaced& replaced = *assembly.trial.replaced;
  // What may ask for memory comes first.
  SolverState state = state_;
  if (own_list_) replaced.list = list_;
  if (own_masses_) {
    replaced.mass = mass_;
    replaced.inverse_mass = inverse_mass_;
    replaced.inverse_inertia = inverse_inertia_;
  }
  assembly.cell = cell_;
  assembly.rows = rows_;
  assembly.bodies = bodies_;
  std::swap(assembly.state, state);
  if (own_list_) {
    std::swap(assembly.pairs, replaced.list);
    replaced.list_positions.swap(state.list.positions);
    replaced.list_taken = true;
  } else {
    assembly.state.list.positions.swap(state.list.positions);
    std::size_t k = 0;
    each_changed(assembly.pairs, [&](Buffer& array) { array = changed_[k++]; });
    assembly.pairs.touched = touched_;
    gather_pairs_that_touch(assembly.pairs);
  }
  if (!own_masses_) return;
  assembly.mass.swap(replaced.mass);
  assembly.inverse_mass.swap(replaced.inverse_mass);
  assembly.inverse_inertia.swap(replaced.inverse_inertia);
  replaced.masses_taken = true;
}

std::size_t TrialCache::bytes() const {
  std::size_t sum = bytes_of(list_) + bytes_of(bodies_) + touched_.capacity() +
                    state_.list.positions.capacity() * sizeof(Vector3) +
                    state_.memory_order.capacity() * sizeof(std::int32_t);
  for (const Buffer* b : {&rows_, &mass_, &inverse_mass_, &inverse_inertia_}) sum += b->capacity() * sizeof(double);
  for (const Buffer& b : changed_) sum += b.capacity() * sizeof(double);
  return sum;
}

}  // namespace rvelab
