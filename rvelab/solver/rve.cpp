#include "rvelab/solver/rve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "rvelab/cell/pressure.hpp"
#include "rvelab/error.hpp"
#include "rvelab/solver/loading/step_times.hpp"
#include "rvelab/solver/resting.hpp"
#include "rvelab/solver/rve_impl.hpp"
#include "rvelab/solver/snapshot.hpp"

namespace rvelab {

namespace {

/// An assembly beyond its limit would fail at its first increment, or hide that it was made with a wrong unit.
void expect_overlaps(const Balance& balance, double limit) {
  // A state within the limit is opened again, whatever its last bits became on the way.
  if (balance.largest_overlap_ratio <= limit * (1 + 1e-9)) return;
  throw InputError("specimen: grains overlap by " + in_words(balance.largest_overlap_ratio) +
                   " of the smaller radius; solver.max_overlap_ratio allows " + in_words(limit) +
                   "; a stiffness too low for the pressure, a slab much thicker than the grains, or mixed units "
                   "(radii in mm?) lead there: correct them, or raise solver.max_overlap_ratio where grains are "
                   "meant to be so soft");
}

}  // namespace

Rve::Rve(const Specimen& specimen) : impl_(std::make_unique<Impl>()) {
  Impl& m = *impl_;
  open_assembly(specimen, m.fixture, m.now);
  set_typical_answers(m.fixture);
  if (m.now.state.look_steps < 0) use_physical_inertia(m.fixture, m.now);
  evaluate_forces(m.fixture, m.now);
  const Balance& balance = m.present_balance();
  if (!balance.finite) throw InputError("specimen: contact forces are not finite; do two grains lie at one place?");
  expect_overlaps(balance, m.fixture.options.max_overlap_ratio);
  if (!(m.to_lab(m.present_stress()) + m.reynolds_stress()).allFinite())
    throw InputError("specimen: its stress is not finite (cell volume " + in_words(m.now.cell.volume()) +
                     " m^3); are cell, masses or velocities in the wrong units? Give all in SI");
  m.set_strained_cell();
  if (m.now.state.look_steps >= 0 && m.holds_more_than_friction()) {
    m.now.state.look_steps = -1;
    use_physical_inertia(m.fixture, m.now);
  }
  if (specimen.state.has_reference) return;
  m.set_missing_references(balance);  // first opening
}

void Rve::Impl::set_missing_references(const Balance& balance) {
  SolverState& state = now.state;
  if (state.reference_overlap == 0)
    state.reference_overlap = balance.touching > 0 ? balance.mean_overlap : 1e-2 * fixture.mean_radius;
  if (state.reference_contact_force == 0)
    state.reference_contact_force =
        balance.touching > 0 ? balance.mean_contact_force : typical_normal_force(fixture, state.reference_overlap);
  if (state.reference_pressure == 0) {
    state.reference_pressure = std::max(0.0, mean_pressure(contact_stress() + reynolds_stress(), fixture.dimension()));
  }
}

void Rve::measure_time(StepTimes* times) { impl_->fixture.times = times; }

double Rve::reference_pressure() const { return impl_->now.state.reference_pressure; }

void Rve::take_as_reference() {
  Impl& m = impl_->up_to_date();
  SolverState& state = m.now.state;
  state.reference_overlap = state.reference_contact_force = state.reference_pressure = 0;
  m.set_missing_references(balance_of(m.fixture, m.now));
  state.look_steps = -1;  // what a barely touching contact counts as goes with the reference
  m.moved();
}

Rve::Rve(const Rve& other) : impl_(std::make_unique<Impl>(*other.impl_)) {}
Rve& Rve::operator=(const Rve& other) {
  if (this != &other) *this = Rve(other);
  return *this;
}
Rve::Rve(Rve&&) noexcept = default;
Rve& Rve::operator=(Rve&&) noexcept = default;
Rve::~Rve() = default;

Matrix3 Rve::Impl::contact_stress() const { return to_lab(-contact_moment(fixture, now) / now.cell.volume()); }

Matrix3 Rve::Impl::strained_stress() const {
  if (!has_deferred()) return contact_stress();
  return contact_stress() + to_lab(extrapolated(now.state.deferred_stretch).stress);
}

Matrix3 Rve::Impl::reynolds_stress() const {
  if (now.state.quasi_static) return Matrix3::Zero();
  return to_lab(kinetic_moment(fixture, now) / now.cell.volume());
}

Matrix3 Rve::contact_stress() const {
  return at_work(*impl_, [](const Impl& m) { return m.strained_stress(); });
}
Matrix3 Rve::reynolds_stress() const {
  return at_work(*impl_, [](const Impl& m) { return m.reynolds_stress(); });
}
Matrix3 Rve::stress() const {
  return at_work(*impl_, [](const Impl& m) -> Matrix3 { return m.strained_stress() + m.reynolds_stress(); });
}

double Rve::unbalanced_ratio() const {
  return at_work(*impl_, [](const Impl& m) { return m.unbalanced(balance_of(m.fixture, m.now)); });
}

const Cell& Rve::cell() const { return impl_->has_deferred() ? impl_->strained_cell : impl_->now.cell; }
bool Rve::cell_thin() const { return impl_->cell_thin(cell()); }
std::size_t Rve::size() const { return impl_->fixture.size(); }
std::uint64_t Rve::grain_steps() const { return impl_->now.state.grain_steps; }
std::uint64_t Rve::grain_steps_made() const { return impl_->grain_steps_made; }

double Rve::critical_time_step() const {
  return at_work(*impl_, [](const Impl& m) { return critical_step(m.fixture, row_sums(m.fixture, m.now)); });
}

Response Rve::Impl::respond(const Report& report, const Matrix3& gradient, double dt, const Want& want) {
  Response r;
  r.report = report;
  r.displacement_gradient = gradient;
  const Matrix3 contact =
                    to_lab(has_deferred() ? Matrix3(present_stress() + extrapolated(now.state.deferred_stretch).stress)
                                          : present_stress()),
                reynolds = reynolds_stress();
  r.stress = contact + reynolds;
  if (want.parts) {
    r.contact_stress = contact;
    r.reynolds_stress = reynolds;
  }
  const int d = fixture.dimension();
  r.report.cell_thin = cell_thin(now.cell);
  if (dt > 0) {
    Matrix3 e = 0.5 * (gradient + gradient.transpose());
    const double mean = e.trace() / d;
    for (int k = 0; k < d; ++k) e(k, k) -= mean;
    double mass = 0, solid = 0;
    for (std::size_t g = 0; g < fixture.size(); ++g) {
      mass += fixture.mass[g];
      solid += grain_volume(fixture.shape, fixture.radius[g], now.cell.lattice(2, 2));
    }
    const double p = mean_pressure(r.stress, d);
    const double rate = std::sqrt(2 * e.squaredNorm()) / dt;
    if (p > 0)
      r.report.inertial_number = rate * 2 * fixture.mean_radius * std::sqrt(mass / solid / p);
    else if (rate > 0)
      r.report.inertial_number = std::numeric_limits<double>::infinity();
  }
  return r;
}

Report Rve::relax(double unbalanced, long max_steps) {
  Impl& m = impl_->at_work();
  const CallClock clock(m.fixture.times);
  return m.guarded([&] {
    Report report;
    const long deferred = m.make_deferred();
    m.begin_quasi_static();
    m.now.state.stress_slope.setZero();
    constexpr long interval = 25;  // sub-steps between looks at the balance
    // Cundall's damping is a part of the force: it hardly takes from a mode without stiffness, such as grains of an
    // even ring that counter-rotate like gears. Who is not at rest after this many steps is stopped at each peak of the
    // kinetic energy (dynamic relaxation: Cundall 1976; Day 1965). The state counts them: a relaxation may be made in
    // as many calls as one likes.
    constexpr long patience = 20'000;
    while (true) {
      m.look();
      report.unbalanced_ratio = m.now.state.unbalanced_ratio;
      if (report.unbalanced_ratio <= unbalanced || report.substeps >= max_steps) break;
      const bool patient = m.now.state.rest_steps < patience;
      const double before = patient ? 0 : kinetic_energy(m.fixture, m.now);
      const long steps = std::min(interval, max_steps - report.substeps);
      m.step_at_rest(steps);
      report.substeps += steps;
      if (!patient && kinetic_energy(m.fixture, m.now) < before) stop_grains(m.fixture, m.now);
    }
    report.target_held = report.unbalanced_ratio <= unbalanced;
    report.substeps += deferred;
    return report;
  });
}

void Rve::share(Workers* team) { impl_->fixture.team = team; }

void Rve::watch(const std::atomic<bool>* stop) { impl_->fixture.stop = stop; }

void Rve::set_materials(const std::vector<Material>& materials) {
  Impl& m = impl_->at_work();
  if (materials.size() != m.fixture.materials.size())
    throw InputError("set_materials: " + std::to_string(materials.size()) + " materials; the specimen has " +
                     std::to_string(m.fixture.materials.size()));
  check_parameters(m.fixture.contact, m.fixture.damping, materials);
  m.up_to_date();
  m.fixture.materials = materials;
  std::vector<double> mass(m.fixture.size()), inertia(m.fixture.size());
  for (std::size_t g = 0; g < m.fixture.size(); ++g) {
    const double density = materials[std::size_t(m.fixture.material[g])].density;
    mass[g] = density * m.fixture.volume_of(g);
    inertia[g] = m.fixture.inertia_of(g, mass[g]);
  }
  m.fixture.mass = std::move(mass);
  m.fixture.inertia = std::move(inertia);
  PairTable& pairs = m.now.pairs;
  const Buffer before = pairs.kt;
  set_pair_parameters(m.fixture, pairs);
  // A tangential spring that has lost its stiffness lets go: what it held is booked.
  for (const std::int32_t place : pairs.order) {
    const auto p = std::size_t(place);
    if (pairs.kt[p] > 0 || !(before[p] > 0)) continue;
    const double root = m.fixture.stores_root_overlap() ? pairs.root_overlap[p] : 1.0;
    double squared = 0;
    for (int k = 0; k < m.fixture.tangential_components(); ++k) {
      squared += pairs.tangential[k][p] * pairs.tangential[k][p];
      pairs.tangential[k][p] = 0;
    }
    if (m.fixture.options.ledger && squared > 0) m.now.state.ledger.law_loss += 0.5 * squared / (before[p] * root);
  }
  set_typical_answers(m.fixture);
  m.now.state.look_steps = -1;
  m.moved();
  evaluate_forces(m.fixture, m.now);
}

void Rve::set_velocities(const std::vector<Vector3>& velocity, const std::vector<Vector3>& spin) {
  Impl& m = impl_->at_work();
  if (velocity.size() != size() || spin.size() != size())
    throw InputError("set_velocities: " + std::to_string(velocity.size()) + " velocities and " +
                     std::to_string(spin.size()) + " spins; the specimen has " + std::to_string(size()) + " grains");
  const auto& order = m.now.state.memory_order;
  const auto index = [&](std::size_t place) { return order.empty() ? place : std::size_t(order[place]); };
  for (std::size_t place = 0; place < size(); ++place)
    if (!velocity[index(place)].allFinite() || !spin[index(place)].allFinite())
      throw InputError("set_velocities: the velocity or spin of grain " + std::to_string(m.fixture.id[place]) +
                       " is not finite; give finite numbers");
  m.up_to_date();
  begin_loading(m.fixture, m.now, Loading::physical);
  for (std::size_t place = 0; place < size(); ++place)
    m.now.set_velocity(m.fixture, place, velocity[index(place)], spin[index(place)]);
  m.now.state.mean_velocity.setZero();
  evaluate_forces(m.fixture, m.now);
  m.moved();
}

void Rve::zero_velocities() {
  Impl& m = impl_->up_to_date();
  stop_grains(m.fixture, m.now);
  evaluate_forces(m.fixture, m.now);
  m.moved();
}

Specimen Rve::specimen() const { return close_assembly(impl_->fixture, impl_->now); }
std::vector<std::byte> Rve::save() const { return to_bytes(specimen()); }
void Rve::restore(std::span<const std::byte> snapshot) {
  Rve restored(from_bytes(snapshot));
  restored.watch(impl_->fixture.stop);
  restored.measure_time(impl_->fixture.times);
  restored.share(impl_->fixture.team);
  *this = std::move(restored);
}

}  // namespace rvelab
