// The representative volume element: apply an increment of displacement gradient (or of it and stress), get the stress.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "rvelab/solver/assembly/network.hpp"
#include "rvelab/solver/loading/mixed_target.hpp"
#include "rvelab/solver/loading/report.hpp"
#include "rvelab/specimen/specimen.hpp"
#include "rvelab/threads/workers.hpp"

namespace rvelab {

enum class TrialCaching;
class State;
struct StepTimes;

/// Throws InvalidIncrement unless dt (s) is 0 or a positive time.
void expect_time(double dt);

/// Calls that change the Rve (those without const) may not run beside any other call of the same one. Const calls
/// change nothing and may run beside each other, except that those of a large cell share its team (share), which takes
/// one call at a time. Different Rves know nothing of each other, copies included.
class Rve {
 public:
  /// Opens a specimen: checks it (InputError; that its neighbour list is of a size to be made, and that no overlap is
  /// beyond solver.max_overlap_ratio, too), chooses the compiled kernels, lists neighbours. Contacts carry their
  /// history; touching pairs that `contacts` does not name start without one.
  explicit Rve(const Specimen& specimen);
  Rve(const Rve&);
  Rve& operator=(const Rve&);
  Rve(Rve&&) noexcept;
  Rve& operator=(Rve&&) noexcept;
  ~Rve();

  /// Applies dH_ij = d(du_i)/dx_j (laboratory frame, finite, spin included) over the time dt (s).
  /// dt > 0: physical masses and rate. dt = 0: quasi-static, dH = 0 is then the identity; the strain per step follows
  /// from the tolerances. To tolerances (solver.target_unbalanced and fixed_substeps are 0), increments that are a
  /// small part of a sub-step share one: the strain is then in the cell at once, the stress follows from its slope over
  /// the increment before, within the estimate, and Report::substeps is 0. Throws InvalidIncrement (refused) or
  /// IncrementFailed; the RVE is then exactly as it was.
  Response apply(const Matrix3& displacement_gradient, double dt);

  /// The same as a trial: commit() makes it the state, revert() brings the committed state back, bit for bit. A pure
  /// function of the committed state and its arguments; apply is attempt and commit. A trial that is pending is
  /// reverted first, here and in every other call that changes the Rve. Throws as apply; no trial is pending then.
  Response attempt(const Matrix3& displacement_gradient, double dt);
  bool pending() const;  ///< whether a trial is; a copy has none, and is in the state that its source showed
  void commit();         ///< nothing without a trial
  void revert() noexcept;
  /// With a trial pending, const calls (stress, network, specimen, cell, save) answer for its end. After exchange()
  /// they answer for the committed state, after a second one for the trial again; nothing else may be called between.
  void exchange() noexcept;
  /// Whether the Rve keeps what a trial did before its first sub-step (masses, a stress that settled), with which other
  /// trials of the same committed state begin, to the same bits. It is gone with that state, and by release().
  bool has_trial_cache() const;

  /// The same with a mixed target: the stress servo runs inside the sub-steps, and the response says which gradient it
  /// found. Throws InputError if the target is not a target (see MixedTarget), InvalidIncrement (dt is negative or not
  /// finite, or the strain that the rows ask for is no deformation) or IncrementFailed; the RVE is then exactly as it
  /// was. In quasi-static loading the target waits for a stress that is let go, and one that the grains cannot carry is
  /// an IncrementFailed (quasi_static/recovery.hpp); at a rate a stress that is missed is no error: Report::target_held
  /// says so.
  Response apply(const MixedTarget& target, double dt);

  /// Quasi-static steps at fixed cell until the unbalanced ratio is at most `unbalanced` (dimensionless) or `max_steps`
  /// sub-steps are made; Report::target_held says which of the two. Throws IncrementFailed (overlaps beyond
  /// solver.max_overlap_ratio, forces not finite); the RVE is then exactly as it was.
  Report relax(double unbalanced, long max_steps);

  Matrix3 stress() const;             ///< Cauchy, laboratory frame, Pa
  Matrix3 contact_stress() const;     ///< (1/V) sum, laboratory frame, Pa
  Matrix3 reynolds_stress() const;    ///< -(1/V) sum m v' v', laboratory frame, Pa; zero after quasi-static loading
  double unbalanced_ratio() const;    ///< of the state as it is, see Report::unbalanced_ratio
  const Cell& cell() const;           ///< lattice (m) in its frame, and the frame's rotation to the laboratory
  bool cell_thin() const;             ///< a cell height is below four mean diameters
  std::size_t size() const;           ///< number of grains
  double critical_time_step() const;  ///< 2/omega_max with physical masses, s
  std::uint64_t grain_steps() const;  ///< grains times sub-steps since the specimen was made
  /// The same of all calls of this Rve, failed and reverted ones too: what they cost. No part of the state.
  std::uint64_t grain_steps_made() const;
  /// Those that trials would have made besides, had each relaxed the committed state for itself: with them a cost does
  /// not depend on what was released in between.
  std::uint64_t grain_steps_shared() const;

  /// Contacts and grains in the cell frame, in the order of the specimen; after an increment that left its strain to
  /// the next sub-step, those of a copy that makes it.
  Network network() const;
  /// The whole state; Rve(specimen()) goes on as this one, bit for bit. Strain that is left to the next sub-step is in
  /// state.control.deferred, not in the lattice.
  Specimen specimen() const;

  /// Releases the buffers that can be made again from state and list, about two thirds of the memory. The next call
  /// that changes the Rve allocates them, in the time of a few sub-steps; no bit changes. A const call that needs them
  /// (stresses, unbalanced ratio, critical time step, network) works on a copy, in the same time, and the Rve stays
  /// released. A trial stays pending, its state and the committed one both released.
  void release();
  bool released() const;
  Memory memory() const;  ///< what is held at this moment

  /// A flag that apply and relax read after each sub-step: once it is true they throw Interrupted, and the RVE is as it
  /// was before the call. Copies read the same flag. It must outlive them; nullptr: none.
  void watch(const std::atomic<bool>* stop);

  /// A team that shares the steps of a large cell, from 30,000 grains on; below, it is left alone. The bits are the
  /// same on any team and on none. Copies use the same team, which must outlive them and must not be at work when a
  /// call is made (an entry of a batch has the thread it runs on); nullptr: none.
  void share(Workers* team);

  /// Adds the time that each part takes to `times` from now on (loading/step_times.hpp). Copies add to the same, which
  /// must outlive them; nullptr: nothing is measured. No result depends on it.
  void measure_time(StepTimes* times);

  /// Mean pressure of the reference state, Pa, by which strain per step and unbalanced ratio are measured; first that
  /// in which the specimen was opened. Far below it quasi-static loading is faster, against the stress that is there,
  /// than target_unbalanced asks.
  double reference_pressure() const;
  /// Makes it the present state, with its contact forces and overlaps.
  void take_as_reference();

  /// Changes contact parameters in place (friction for preparation, no slip for probes); history is kept. One material
  /// for each that the specimen has, in its order. InputError if their number differs or one is not allowed by the law
  /// (check_parameters in contact/model.hpp); the RVE is then as it was.
  void set_materials(const std::vector<Material>& materials);
  /// The interactions other than contacts (bonds), ordered by their pairs; cell frame. set_interactions replaces them.
  /// InputError, and the RVE is as it was, if a grain is none of it, a pair stands twice or a number is not allowed.
  Interactions interactions() const;
  void set_interactions(const Interactions& interactions);
  /// What those form from that form by themselves (water). If set_interactions brings others, those that are there
  /// become what these make of them; without any, they go.
  const InteractionSettings& interaction_settings() const;
  /// Energy balance since the specimen was first opened (solver/README.md); nullptr where it is not computed
  /// (solver.energy_balance). Until the next call that changes the Rve. What set_interactions changes of the stored
  /// energy is booked in it as given by stages.
  const EnergyTerms* energy_balance() const;
  /// Sets fluctuation velocities and spins (cell frame, m/s and rad/s), at a rate: one of each for every grain, in the
  /// order of the specimen. In the plane the components out of it are left out. InputError if a number of entries is
  /// not size() or an entry is not finite; the RVE is then as it was.
  void set_velocities(const std::vector<Vector3>& velocity, const std::vector<Vector3>& spin);
  /// Zeroes fluctuation velocities and spins; the kinetic energy is booked as removed.
  void zero_velocities();

  /// Bitwise snapshot of everything that decides the next bit, for builds whose specimens have the same fields (a
  /// specimen file carries a state further), and the way back. The flag of watch(), the team of share() and
  /// measure_time() stay.
  /// restore takes any number of grains, materials and either shape: what the Rve held before does not matter. It
  /// throws InputError, and the RVE is then exactly as it was, if the bytes do not begin as a snapshot, are of a build
  /// with other fields, have another length than their head says, do not fit their checksum, hold a length, a choice or
  /// a boolean that cannot be, or if the state that they hold cannot be opened (Rve(specimen)).
  std::vector<std::byte> save() const;
  void restore(std::span<const std::byte> snapshot);

 private:
  Response make_trial(const Matrix3& displacement_gradient, double dt, TrialCaching caching);
  const State& state() const { return *state_; }
  /// What watch, share and measure_time set stays.
  void open_instead(const Specimen& specimen);

  std::unique_ptr<State> state_;
};

}  // namespace rvelab
