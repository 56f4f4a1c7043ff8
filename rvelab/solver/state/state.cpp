#include "rvelab/solver/state/state.hpp"

#include <algorithm>
#include <utility>

#include "rvelab/cell/cell.hpp"
#include "rvelab/error.hpp"
#include "rvelab/solver/assembly/contact_states.hpp"
#include "rvelab/solver/loading/typical_answers.hpp"

namespace rvelab {

namespace {

/// Grains up to which an RVE keeps the buffers of a trial for the next one (some 10 MB).
constexpr std::size_t largest_kept_trial = 20'000;

/// An assembly beyond its limit would fail at its first increment, or hide that it was made with a wrong unit.
void expect_overlaps(const OutOfBalance& balance, double limit) {
  // A state within the limit is opened again, whatever its last bits became on the way.
  if (balance.largest_overlap_ratio <= limit * (1 + 1e-9)) return;
  throw InputError("specimen: grains overlap by " + in_words(balance.largest_overlap_ratio) +
                   " of the smaller radius; solver.max_overlap_ratio allows " + in_words(limit) +
                   "; a stiffness too low for the pressure, a slab much thicker than the grains, or mixed units "
                   "(radii in mm?) lead there: correct them, or raise solver.max_overlap_ratio where grains are "
                   "meant to be so soft");
}

/// Tangential springs that lose their stiffness let go; what they held is booked. `before`: their stiffnesses so far.
void let_go_of_springs(const Model& model, const Buffer& before, Assembly& assembly) {
  PairTable& pairs = assembly.pairs;
  for (const std::int32_t row : pairs.order) {
    const auto p = std::size_t(row);
    if (pairs.kt[p] > 0 || !(before[p] > 0)) continue;
    const double last = with_force(model, [&](auto force) {
      using Force = decltype(force);
      return Force::tangential_stiffness(before[p], Force::stores_root_overlap ? pairs.root_overlap[p] : 1.0);
    });
    double squared = 0;
    for (int k = 0; k < model.tangential_components(); ++k) {
      squared += pairs.tangential[k][p] * pairs.tangential[k][p];
      pairs.tangential[k][p] = 0;
    }
    if (model.options.energy_balance && squared > 0) assembly.state.energy_balance.law_loss += 0.5 * squared / last;
  }
}

}  // namespace

State::State(const Specimen& specimen) {
  open_assembly(specimen, model_, assembly_);
  set_typical_answers(model_);
  if (!masses().in_use) use_physical_inertia(model_, assembly_);
  evaluate_forces(model_, assembly_);
  if (!out_of_balance().finite)
    throw InputError("specimen: contact forces are not finite; do two grains lie at one place?");
  expect_overlaps(out_of_balance(), model_.options.max_overlap_ratio);
  if (!(to_lab(stress()) + reynolds_stress()).allFinite())
    throw InputError("specimen: its stress is not finite (cell volume " + in_words(cell().volume()) +
                     " m^3); are cell, masses or velocities in the wrong units? Give all in SI");
  set_strained_cell();
  if (masses().in_use && holds_more_than_friction(model_, assembly_)) {
    masses() = {};
    use_physical_inertia(model_, assembly_);
  }
  if (!specimen.state.list.built) set_missing_references();  // first opening
}

void State::set_missing_references() {
  Reference& reference = assembly_.state.reference;
  const OutOfBalance& balance = out_of_balance();
  if (reference.overlap == 0)
    reference.overlap = balance.touching > 0 ? balance.mean_overlap : 1e-2 * model_.mean_radius;
  if (reference.contact_force == 0)
    reference.contact_force =
        balance.touching > 0 ? balance.mean_contact_force : typical_normal_force(model_, reference.overlap);
  if (reference.pressure == 0)
    reference.pressure = std::max(0.0, mean_pressure(contact_stress() + reynolds_stress(), model_.dimension()));
}

const Matrix3& State::stress() {
  return derived_.stress.of(derived_.generation,
                            [this] { return Matrix3(-contact_virial(model_, assembly()) / cell().volume()); });
}

const OutOfBalance& State::out_of_balance() {
  return derived_.balance.of(derived_.generation, [this] { return balance_of(model_, assembly()); });
}

const InteractionSums& State::interaction_sums() {
  return derived_.interaction_sums.of(derived_.generation,
                                      [this] { return rvelab::interaction_sums(model_, assembly()); });
}

const RowSums& State::row_sums() {
  return sums_.of(derived_.generation, [this] { return rvelab::row_sums(model_, assembly()); });
}

const OutOfBalance& State::checked_balance() {
  check_height(model_, cell());  // as a list does, but only when it is built
  check_overlaps(model_, out_of_balance());
  return out_of_balance();
}

void State::note_unbalanced_ratio() {
  control().unbalanced_ratio = unbalanced_ratio(out_of_balance());
  derived_.ratio_generation = derived_.generation;
}

double State::unbalanced_ratio(const OutOfBalance& balance) const {
  return rvelab::unbalanced_ratio(balance, reference().contact_force);
}

Matrix3 State::contact_stress() const { return to_lab(-contact_virial(model_, assembly_) / cell().volume()); }

Matrix3 State::reynolds_stress() const {
  if (last_step().loading == Loading::quasi_static) return Matrix3::Zero();
  return to_lab(reynolds_stress_times_volume(model_, assembly_) / cell().volume());
}

Advanced State::advance(const Advance& what) {
  const Advanced made = make_substeps(model_, change(), what);
  count(made.steps);
  return made;
}

void State::set_loading(Loading loading) {
  // Where the kind of loading changes dashpot forces vanish; the stress does not depend on masses.
  const bool changes = last_step().loading != loading;
  rvelab::set_loading(model_, changes ? change() : assembly_, loading);
}

void State::turn(const Matrix3& frame_rotation) {
  turn_frame(assembly_.cell, frame_rotation);
  set_strained_cell();
}

void State::set_rotation(const Matrix3& rotation) {
  assembly_.cell.rotation = rotation;
  set_strained_cell();
}

void State::set_deferred(const Matrix3& stretch) {
  control().deferred.stretch = stretch;
  set_strained_cell();
}

void State::set_deferred_and_turn(const Matrix3& stretch, const Matrix3& frame_rotation) {
  control().deferred.stretch = stretch;
  turn(frame_rotation);
}

void State::set_strained_cell() {
  if (!has_deferred()) return;
  strained_cell_ = cell();
  strained_cell_.lattice = control().deferred.stretch * cell().lattice;
}

void State::set_materials(const std::vector<Material>& materials) {
  Assembly& assembly = change();
  model_.materials = materials;
  set_physical_masses(model_);
  const Buffer before = assembly.pairs.kt;
  set_pair_parameters(model_, assembly.pairs);
  let_go_of_springs(model_, before, assembly);
  // Stored roots are of the roughness so far.
  if (with_force(model_, [](auto force) { return decltype(force)::root_has_constant; }))
    std::fill(assembly.pairs.root_overlap.begin(), assembly.pairs.root_overlap.end(), 0.0);
  set_typical_answers(model_);
  assembly.state.masses = {};
  evaluate_forces(model_, assembly);
}

void State::set_velocities(const std::vector<Vector3>& velocity, const std::vector<Vector3>& spin) {
  set_loading(Loading::at_rate);
  Assembly& assembly = change();
  for (std::size_t row = 0; row < model_.size(); ++row)
    assembly.set_velocity(model_, row, velocity[index_in_specimen(row)], spin[index_in_specimen(row)]);
  assembly.state.last_step.mean_velocity.setZero();
  evaluate_forces(model_, assembly);
}

void State::zero_velocities() {
  Assembly& assembly = change();
  stop_grains(model_, assembly);
  evaluate_forces(model_, assembly);
}

void State::take_as_reference() {
  SolverState& state = change().state;
  state.reference = {};
  set_missing_references();
  state.masses = {};  // what a barely touching contact counts as goes with the reference
}

void State::begin_trial(Trial::Changes changes) {
  if (changes == Trial::Changes::deferred_strain) evaluate_stale_forces();  // it moves no grain: they stay
  trial_.begin(assembly_, changes);
  of_other_ = derived_;
}

void State::exchange_but_forces() noexcept {
  trial_.exchange(assembly_);
  std::swap(derived_, of_other_);
  set_strained_cell();
  forces_are_stale_ = trial_.changes() == Trial::Changes::grains && !released_;
}

void State::evaluate_forces_again() noexcept {
  rvelab::evaluate_forces_again(model_, assembly_);
  forces_are_stale_ = false;
}

void State::exchange() noexcept {
  exchange_but_forces();
  evaluate_stale_forces();
}

void State::revert() noexcept {
  exchange();
  end_trial();
}

void State::revert_but_forces() noexcept {
  exchange_but_forces();
  end_trial();
}

void State::commit() noexcept {
  end_trial();
  drop_trial_cache();
}

void State::end_trial() noexcept {
  trial_.end(assembly_);
  if (released_ || model_.size() > largest_kept_trial) trial_.release();
}

void State::keep_trial_cache(CachedRelaxation relaxation) noexcept {
  if (model_.size() > largest_kept_trial) return;
  cache_.keep(assembly(), trial_.other_cell().lattice, std::move(relaxation));
  of_cache_ = derived_;
}

void State::take_trial_cache() {
  cache_.take_over(assembly_);
  derived_ = of_cache_;
  forces_are_stale_ = false;
  set_strained_cell();
}

void State::release() {
  put_masses_into_rows(model_, assembly_);
  sums_ = {};
  cache_ = {};
  released_ = true;
  forces_are_stale_ = false;  // allocate evaluates them
  if (pending()) {
    exchange();
    put_masses_into_rows(model_, assembly_);  // often the same as those of the trial: released after both
    release_buffers(assembly_);
    exchange();
  } else {
    trial_.release();
  }
  release_buffers(assembly_);
}

void State::allocate() {
  if (released_) rebuild_buffers(model_, assembly_);
  released_ = false;
}

Memory State::memory() const {
  Memory memory = memory_of(assembly_);
  const RowSums& sums = sums_.last();
  for (const auto* each : {&sums.translation, &sums.rotation, &sums.dashpot})
    memory.working += each->capacity() * sizeof(double);
  (pending() ? memory.trial : memory.working) += trial_.bytes() + cache_.bytes();
  return memory;
}

}  // namespace rvelab
