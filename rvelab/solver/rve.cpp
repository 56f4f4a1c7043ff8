#include "rvelab/solver/rve.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "rvelab/cell/cell.hpp"
#include "rvelab/error.hpp"
#include "rvelab/solver/assembly/contact_states.hpp"
#include "rvelab/solver/assembly/interactions.hpp"
#include "rvelab/solver/at_rate/at_rate.hpp"
#include "rvelab/solver/loading/step_times.hpp"
#include "rvelab/solver/quasi_static/deferred.hpp"
#include "rvelab/solver/quasi_static/quasi_static.hpp"
#include "rvelab/solver/snapshot.hpp"
#include "rvelab/solver/state/state.hpp"
#include "rvelab/specimen/specimen_check.hpp"

namespace rvelab {

namespace {

/// A state for a call that changes it: no trial is pending, all buffers are there.
State& prepared_for_change(State& state) {
  if (state.pending()) state.revert();
  state.drop_trial_cache();
  state.allocate();
  return state;
}

/// The same for another trial.
State& prepared_for_trial(State& state) {
  if (state.pending()) state.revert_but_forces();
  state.allocate();
  return state;
}

/// Runs `work` as a trial, which is then pending; if it throws, the trial is reverted and the exception goes on, a
/// CellError as IncrementFailed.
template <class Work>
auto run_as_trial(State& state, Trial::Changes changes, const Work& work) {
  state.begin_trial(changes);
  try {
    return work();
  } catch (const CellError& error) {
    state.revert();
    throw IncrementFailed(error.what());
  } catch (...) {
    state.revert();
    throw;
  }
}

template <class Work>
auto run_and_commit(State& state, const Work& work) {
  auto result = run_as_trial(state, Trial::Changes::grains, work);
  state.commit();
  return result;
}

/// The same with the deferred strain made, for calls that change more than the strain.
State& apply_deferred_strain(State& state) {
  prepared_for_change(state);
  if (state.has_deferred()) run_and_commit(state, [&] { return apply_deferred(state); });
  return state;
}

/// Asks a state that has its buffers and forces. A const call changes nothing: where it has not, a copy is asked.
template <class Question>
auto answer(const State& state, const Question& question) {
  if (state.has_forces()) return question(state);
  State copy = state;
  copy.allocate();
  copy.assembly();
  return question(std::as_const(copy));
}

/// Contact stress, laboratory frame, Pa, with that of the deferred strain.
Matrix3 strained_stress(const State& state) {
  if (!state.has_deferred()) return state.contact_stress();
  return state.contact_stress() + state.to_lab(extrapolated(state, state.control().deferred.stretch).stress);
}

/// In interactions other than contacts, J; 0 where no energy is booked.
double stored_in_interactions(State& state) {
  double sum = 0;
  if (state.model().options.energy_balance)
    for (const InteractionState& each : network_of(state.model(), state.assembly()).interactions)
      sum += each.elastic_energy;
  return sum;
}

double inertial_number(const State& state, const Matrix3& gradient, double dt, const Matrix3& stress) {
  const Model& model = state.model();
  const int d = model.dimension();
  Matrix3 e = 0.5 * (gradient + gradient.transpose());
  const double mean = e.trace() / d;
  for (int k = 0; k < d; ++k) e(k, k) -= mean;
  double mass = 0, solid = 0;
  for (std::size_t g = 0; g < model.size(); ++g) {
    mass += model.mass[g];
    solid += model.solid_of(g);
  }
  const double p = mean_pressure(stress, d), rate = std::sqrt(2 * e.squaredNorm()) / dt;
  if (p > 0) return rate * 2 * model.mean_radius * std::sqrt(mass / solid / p);
  return rate > 0 ? std::numeric_limits<double>::infinity() : 0.0;
}

/// `by_deferred`: change of the stress by the deferred strain, cell frame, Pa.
Response respond(State& state, const Report& report, const Matrix3& gradient, double dt, const Matrix3& by_deferred) {
  const Matrix3 contact = state.to_lab(state.stress() + by_deferred), reynolds = state.reynolds_stress();
  Response r{contact + reynolds, contact, reynolds, gradient, report};
  r.report.cell_thin = state.is_thin(state.cell());
  if (loading_of(dt) == Loading::at_rate) r.report.inertial_number = inertial_number(state, gradient, dt, r.stress);
  return r;
}

Response respond(State& state, const Report& report, const Matrix3& gradient, double dt) {
  Matrix3 by_deferred = Matrix3::Zero();
  if (state.has_deferred()) by_deferred = extrapolated(state, state.control().deferred.stretch).stress;
  return respond(state, report, gradient, dt, by_deferred);
}

/// An increment as it is checked and split once.
struct Increment {
  const Matrix3& gradient;
  double dt;
  FrameSplit split;
};

Report load_increment(State& state, Increment increment, TrialCaching caching) {
  const bool quasi_static = loading_of(increment.dt) == Loading::quasi_static;
  if (quasi_static && increment.split.rigid) return load_rotation(state, increment.split, increment.gradient);
  long deferred = 0;
  if (state.has_deferred() && !(quasi_static && is_along_deferred(state, increment.split))) {
    deferred = apply_deferred(state);
    increment.split = split_increment(state.cell(), increment.gradient);  // the lattice may have been reduced
  }
  Report report = quasi_static ? load_quasi_static(state, increment.split, caching)
                               : load_at_rate(state, increment.split, increment.dt);
  report.substeps += deferred;
  return report;
}

}  // namespace

void expect_time(double dt) {
  constexpr double shortest = 1e-30;  // s; in less the squares of rates are beyond all numbers
  if (dt == 0 || (dt >= shortest && std::isfinite(dt))) return;
  throw InvalidIncrement("apply: dt = " + in_words(dt) +
                         " s; it must be 0 (quasi-static) or a time of at least 1e-30 s");
}

Rve::Rve(const Specimen& specimen) : state_(std::make_unique<State>(specimen)) {}
Rve::Rve(const Rve& other) : state_(std::make_unique<State>(*other.state_)) {}
Rve& Rve::operator=(const Rve& other) {
  if (this != &other) *this = Rve(other);
  return *this;
}
Rve::Rve(Rve&&) noexcept = default;
Rve& Rve::operator=(Rve&&) noexcept = default;
Rve::~Rve() = default;

Response Rve::attempt(const Matrix3& displacement_gradient, double dt) {
  return make_trial(displacement_gradient, dt, TrialCaching::on);
}

Response Rve::apply(const Matrix3& displacement_gradient, double dt) {
  const Response response = make_trial(displacement_gradient, dt, TrialCaching::off);
  commit();
  return response;
}

Response Rve::make_trial(const Matrix3& displacement_gradient, double dt, TrialCaching caching) {
  State& state = prepared_for_trial(*state_);
  expect_time(dt);
  const CallClock clock(state.model().times);
  const Increment increment{displacement_gradient, dt, split_increment(state.cell(), displacement_gradient)};
  std::optional<Deferral> deferral;
  if (loading_of(dt) == Loading::quasi_static) deferral = deferral_of(state, increment.split);
  if (!deferral)
    return run_as_trial(state, Trial::Changes::grains, [&] {
      const Report report = load_increment(state, increment, caching);
      return respond(state, report, displacement_gradient, dt);
    });
  // It moves no grain: the trial is the cell alone.
  return run_as_trial(state, Trial::Changes::deferred_strain, [&] {
    const Report report = defer(state, increment.split, *deferral);
    return respond(state, report, displacement_gradient, dt, deferral->change.stress);
  });
}

Response Rve::apply(const MixedTarget& target, double dt) {
  State& state = prepared_for_change(*state_);
  expect_time(dt);
  const CallClock clock(state.model().times);
  return run_and_commit(state, [&] {
    Matrix3 gradient = Matrix3::Zero();
    const long deferred = apply_deferred(state);
    state.control().deferred.stress_slope.setZero();
    Report report = loading_of(dt) == Loading::at_rate ? follow_target_at_rate(state, target, dt, gradient)
                                                       : follow_target_quasi_static(state, target, gradient);
    report.substeps += deferred;
    return respond(state, report, gradient, dt);
  });
}

Report Rve::relax(double unbalanced, long max_steps) {
  State& state = prepared_for_change(*state_);
  const CallClock clock(state.model().times);
  return run_and_commit(state, [&] { return rvelab::relax(state, unbalanced, max_steps); });
}

bool Rve::has_trial_cache() const { return state_->has_trial_cache(); }
bool Rve::pending() const { return state_->pending(); }
void Rve::commit() {
  if (pending()) state_->commit();
}
void Rve::revert() noexcept {
  if (pending()) state_->revert();
}
void Rve::exchange() noexcept {
  if (pending()) state_->exchange();
}

void Rve::release() { state_->release(); }
bool Rve::released() const { return state_->released(); }
Memory Rve::memory() const { return state_->memory(); }

Matrix3 Rve::contact_stress() const { return answer(*state_, strained_stress); }
Matrix3 Rve::reynolds_stress() const {
  return answer(*state_, [](const State& state) { return state.reynolds_stress(); });
}
Matrix3 Rve::stress() const {
  return answer(*state_,
                [](const State& state) -> Matrix3 { return strained_stress(state) + state.reynolds_stress(); });
}

double Rve::unbalanced_ratio() const {
  return answer(*state_,
                [](const State& state) { return state.unbalanced_ratio(balance_of(state.model(), state.assembly())); });
}

double Rve::critical_time_step() const {
  return answer(*state_, [](const State& state) {
    return critical_step(state.model(), row_sums(state.model(), state.assembly()));
  });
}

Network Rve::network() const {
  const auto network = [](const State& state) { return network_of(state.model(), state.assembly()); };
  if (!state_->has_deferred()) return answer(*state_, network);
  State copy = *state_;
  try {
    apply_deferred_strain(copy);
  } catch (const Interrupted&) {
    throw;
  } catch (const Error&) {  // the grains are shown as they are
  }
  return answer(copy, network);
}

const Cell& Rve::cell() const { return state_->strained_cell(); }
bool Rve::cell_thin() const { return state_->is_thin(cell()); }
std::size_t Rve::size() const { return state_->model().size(); }
std::uint64_t Rve::grain_steps() const { return state().assembly().state.grain_steps; }
std::uint64_t Rve::grain_steps_made() const { return state_->grain_steps_made(); }
std::uint64_t Rve::grain_steps_shared() const { return state_->grain_steps_shared(); }
double Rve::reference_pressure() const { return state_->reference().pressure; }

void Rve::watch(const std::atomic<bool>* stop) { state_->watch(stop); }
void Rve::share(Workers* team) { state_->share(team); }
void Rve::measure_time(StepTimes* times) { state_->measure_time(times); }

void Rve::set_materials(const std::vector<Material>& materials) {
  State& state = prepared_for_change(*state_);
  if (materials.size() != state.model().materials.size())
    throw InputError("set_materials: " + std::to_string(materials.size()) + " materials; the specimen has " +
                     std::to_string(state.model().materials.size()));
  check_parameters(state.model().contact, state.model().damping, materials);
  apply_deferred_strain(state).set_materials(materials);
}

Interactions Rve::interactions() const {
  // A large cell keeps its grains in an order of its own.
  const Assembly& assembly = state().assembly();
  if (!assembly.state.memory_order.empty()) return Interactions(specimen());
  Interactions all = interactions_of(assembly.pairs);
  copy_settings(state_->model().interaction_settings, all);
  return all;
}

void Rve::set_interactions(const Interactions& interactions) {
  const double stored = stored_in_interactions(apply_deferred_strain(prepared_for_change(*state_)));
  Specimen changed = specimen();
  static_cast<Interactions&>(changed) = interactions;
  check_specimen(changed);  // that they can form, before they are made
  prepare_interactions(changed);
  changed.state.masses = {};  // they go with the stiffness
  open_instead(changed);
  state_->energy_balance().book(&InteractionTerms::stages, stored_in_interactions(*state_) - stored);
}

const EnergyTerms* Rve::energy_balance() const {
  return state_->model().options.energy_balance ? &state().assembly().state.energy_balance : nullptr;
}

const InteractionSettings& Rve::interaction_settings() const { return state_->model().interaction_settings; }

void Rve::set_velocities(const std::vector<Vector3>& velocity, const std::vector<Vector3>& spin) {
  State& state = prepared_for_change(*state_);
  if (state.model().bodies)
    throw InputError(
        "set_velocities: the grains are bodies (clumps, superellipsoids); set the velocities and spins of the bodies "
        "of a specimen "
        "instead (bodies/velocity, bodies/spin)");
  if (velocity.size() != size() || spin.size() != size())
    throw InputError("set_velocities: " + std::to_string(velocity.size()) + " velocities and " +
                     std::to_string(spin.size()) + " spins; the specimen has " + std::to_string(size()) + " grains");
  for (std::size_t row = 0; row < size(); ++row) {
    const std::size_t index = state.index_in_specimen(row);
    if (!velocity[index].allFinite() || !spin[index].allFinite())
      throw InputError("set_velocities: the velocity or spin of grain " + std::to_string(state.model().id[row]) +
                       " is not finite; give finite numbers");
  }
  apply_deferred_strain(state).set_velocities(velocity, spin);
}

void Rve::zero_velocities() { apply_deferred_strain(*state_).zero_velocities(); }
void Rve::take_as_reference() { apply_deferred_strain(*state_).take_as_reference(); }

Specimen Rve::specimen() const { return close_assembly(state().model(), state().assembly()); }
std::vector<std::byte> Rve::save() const { return to_bytes(specimen()); }
void Rve::restore(std::span<const std::byte> snapshot) { open_instead(from_bytes(snapshot)); }

void Rve::open_instead(const Specimen& specimen) {
  Rve opened(specimen);
  const Model& model = state_->model();
  opened.watch(model.stop);
  opened.measure_time(model.times);
  opened.share(model.team);
  *this = std::move(opened);
}

}  // namespace rvelab
