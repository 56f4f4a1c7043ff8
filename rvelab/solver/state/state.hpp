// What an RVE is: the model, which no increment changes, and the assembly in its cell. What follows from them is kept
// with the number of the generation that it was derived from, and whoever changes the assembly raises that number: a
// value that is no longer true cannot be had. Beside it stands the other state of a pending trial.
#pragma once

#include "rvelab/solver/assembly/assembly.hpp"
#include "rvelab/solver/assembly/interactions.hpp"
#include "rvelab/solver/loading/inertia.hpp"
#include "rvelab/solver/loading/report.hpp"
#include "rvelab/solver/loading/stepping.hpp"
#include "rvelab/solver/loading/velocities.hpp"
#include "rvelab/solver/state/trial.hpp"
#include "rvelab/solver/state/trial_cache.hpp"

namespace rvelab {

// Buffers that an assembly can make again: released while an RVE waits, allocated again for the next call.

/// The grain rows keep the masses for as long as the working arrays are released.
void put_masses_into_rows(const Model& model, Assembly& assembly);
/// Frees the working arrays; only rebuild_buffers, close_assembly and memory_of may be called then.
void release_buffers(Assembly& assembly);

/// Makes them again: the bits are those before. Throws std::bad_alloc; the assembly has none of them then.
void rebuild_buffers(const Model& model, Assembly& assembly);

Memory memory_of(const Assembly& assembly);

/// A value derived from a state, and the generation of it.
template <class Value>
class Derived {
 public:
  template <class Make>
  const Value& of(std::uint64_t generation, const Make& make) {
    if (generation_ != generation) value_ = make();
    generation_ = generation;
    return value_;
  }
  /// As last derived, of whatever generation.
  const Value& last() const { return value_; }

 private:
  Value value_{};
  std::uint64_t generation_ = 0;  ///< 0: of none
};

class State {
 public:
  /// Opens a specimen; throws InputError as Rve's constructor says.
  explicit State(const Specimen& specimen);

  const Model& model() const { return model_; }
  /// Its forces are those of this state: where they are stale they are evaluated first. A const State cannot do that;
  /// has_forces says whether they are.
  const Assembly& assembly() {
    evaluate_stale_forces();
    return assembly_;
  }
  const Assembly& assembly() const { return assembly_; }
  bool has_forces() const { return !released_ && !forces_are_stale_; }
  const Cell& cell() const { return assembly_.cell; }
  /// To change grains, contacts, cell or references: raises the generation.
  Assembly& change() {
    evaluate_stale_forces();
    derived_.generation = ++last_generation_;
    return assembly_;
  }
  // Parts of the state from which nothing is derived.
  QuasiStaticControl& control() { return assembly_.state.control; }
  const QuasiStaticControl& control() const { return assembly_.state.control; }
  ServoState& servo() { return assembly_.state.servo; }
  LastStep& last_step() { return assembly_.state.last_step; }
  const LastStep& last_step() const { return assembly_.state.last_step; }
  ScaledMasses& masses() { return assembly_.state.masses; }
  const ScaledMasses& masses() const { return assembly_.state.masses; }
  EnergyTerms& energy_balance() { return assembly_.state.energy_balance; }
  const Reference& reference() const { return assembly_.state.reference; }

  const Matrix3& stress();  ///< of the contacts, cell frame, Pa
  const OutOfBalance& out_of_balance();
  const InteractionSums& interaction_sums();
  const RowSums& row_sums();  ///< of stiffness; they take as long as two sub-steps
  /// The same. Throws IncrementFailed where the cell is too thin, an overlap beyond the limit or a value not finite.
  const OutOfBalance& checked_balance();
  /// Notes the present ratio as measured on the present generation, which ratio_is_measured tells of.
  void note_unbalanced_ratio();
  bool ratio_is_measured() const { return derived_.ratio_generation == derived_.generation; }
  /// With this specimen's reference force.
  double unbalanced_ratio(const OutOfBalance& balance) const;

  /// Index into the specimen's grains of the grain in a row of memory.
  std::size_t index_in_specimen(std::size_t row) const {
    return assembly_.state.memory_order.empty() ? row : std::size_t(assembly_.state.memory_order[row]);
  }

  Matrix3 to_lab(const Matrix3& cell_frame) const { return cell().rotation * cell_frame * cell().rotation.transpose(); }
  Matrix3 contact_stress() const;   ///< laboratory frame, Pa; not kept
  Matrix3 reynolds_stress() const;  ///< laboratory frame, Pa; zero in quasi-static loading
  /// A cell height is below four mean diameters.
  bool is_thin(const Cell& cell) const { return heights(cell).minCoeff() < 8 * model_.mean_radius; }

  /// Makes sub-steps (loading/stepping.hpp).
  Advanced advance(const Advance& what);
  /// Velocities, masses and spins for a kind of loading (loading/velocities.hpp).
  void set_loading(Loading loading);
  /// Masses of quasi-static loading from the present row sums; the second books the change of kinetic energy.
  void scale_masses() { scale_inertia(model_, row_sums(), assembly_); }
  void rescale_masses() { rescale_inertia(model_, row_sums(), assembly_); }
  /// In quasi-static loading, where no force depends on a velocity.
  void stop_quasi_static() { stop_grains(model_, assembly_); }
  /// Turns the frame of the cell.
  void turn(const Matrix3& frame_rotation);
  void set_rotation(const Matrix3& rotation);

  /// Strain that is applied but left to the next sub-step (quasi_static/deferred.hpp).
  bool has_deferred() const { return !(control().deferred.stretch.array() == Matrix3::Identity().array()).all(); }
  void set_deferred(const Matrix3& stretch);
  /// Sets the deferred stretch and turns the frame of the cell.
  void set_deferred_and_turn(const Matrix3& stretch, const Matrix3& frame_rotation);
  /// The cell with it.
  const Cell& strained_cell() const { return has_deferred() ? strained_cell_ : cell(); }

  // What Rve says of these; materials and velocities are checked there.
  void set_materials(const std::vector<Material>& materials);
  void set_velocities(const std::vector<Vector3>& velocity, const std::vector<Vector3>& spin);
  void zero_velocities();
  void take_as_reference();
  void watch(const std::atomic<bool>* stop) { model_.stop = stop; }
  void share(Workers* team) { model_.team = team; }
  void measure_time(StepTimes* times) { model_.times = times; }
  /// Of all calls, failed and reverted ones too; `count` adds those of a copy that was advanced beside.
  std::uint64_t grain_steps_made() const { return grain_steps_made_; }
  void count(long substeps) { grain_steps_made_ += std::uint64_t(substeps) * model_.size(); }
  /// Those that a trial need not make, since another of its committed state did.
  std::uint64_t grain_steps_shared() const { return grain_steps_shared_; }
  void count_shared(long substeps) { grain_steps_shared_ += std::uint64_t(substeps) * model_.size(); }

  void begin_trial(Trial::Changes changes);
  bool pending() const { return trial_.pending(); }
  void exchange() noexcept;
  void revert() noexcept;
  /// The same before another trial, which may begin with the forces of the cache: until then, or until they are used,
  /// they are stale.
  void revert_but_forces() noexcept;
  void commit() noexcept;  ///< what is here is the state, and no trial is pending

  // What trials of this committed state begin with (trial_cache.hpp); until the state is another.
  bool has_trial_cache() const { return cache_.kept(); }
  CachedRelaxation& cached_relaxation() { return cache_.cached_relaxation(); }
  void keep_trial_cache(CachedRelaxation relaxation) noexcept;
  void take_trial_cache();
  void drop_trial_cache() noexcept { cache_.drop(); }

  /// Releases what can be made again, of both states of a pending trial; allocate makes it again.
  void release();
  void allocate();
  bool released() const { return released_; }
  Memory memory() const;

 private:
  /// What is derived of a state, and the generation of it.
  struct DerivedValues {
    std::uint64_t generation = 1;
    std::uint64_t ratio_generation = 0;  ///< in which control().unbalanced_ratio was measured
    Derived<Matrix3> stress;
    Derived<OutOfBalance> balance;
    Derived<InteractionSums> interaction_sums;
  };

  void set_missing_references();
  void evaluate_stale_forces() noexcept {
    if (forces_are_stale_) evaluate_forces_again();
  }
  void evaluate_forces_again() noexcept;
  void set_strained_cell();
  void exchange_but_forces() noexcept;
  void end_trial() noexcept;

  Model model_;
  Assembly assembly_;
  Trial trial_;
  TrialCache cache_;
  bool released_ = false, forces_are_stale_ = false;
  Cell strained_cell_;
  std::uint64_t grain_steps_made_ = 0, grain_steps_shared_ = 0;
  std::uint64_t last_generation_ = 1;
  DerivedValues derived_, of_other_, of_cache_;  ///< of_other_: of the state of a pending trial not in `assembly_`
  Derived<RowSums> sums_;
};

}  // namespace rvelab
