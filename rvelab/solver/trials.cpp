// Rve::apply, attempt, commit, revert; Rve::rest and the buffers that a state at rest is without. Declared in rve.hpp.
#include <cmath>
#include <sstream>

#include "rvelab/error.hpp"
#include "rvelab/solver/loading/step_times.hpp"
#include "rvelab/solver/resting.hpp"
#include "rvelab/solver/rve.hpp"
#include "rvelab/solver/rve_impl.hpp"

namespace rvelab {

namespace {

void expect_time(double dt) {
  constexpr double shortest = 1e-30;  // s; in less the squares of rates are beyond all numbers
  if (dt == 0 || (dt >= shortest && std::isfinite(dt))) return;
  std::ostringstream text;
  text << "apply: dt = " << dt << " s; it must be 0 (quasi-static) or a time of at least 1e-30 s";
  throw InvalidIncrement(text.str());
}

}  // namespace

void Rve::Impl::begin_trial(Trial::Changes changes) {
  trial.begin(now, changes);
  other_stress = stress;
  other_stress_holds = stress_holds;
}

void Rve::Impl::exchange() noexcept {
  trial.exchange(fixture, now, resting);
  std::swap(stress, other_stress);
  std::swap(stress_holds, other_stress_holds);
  balance_holds = ratio_holds = false;
  if (trial.changes() == Trial::Changes::grains) sums_hold = false;
  set_strained_cell();
}

void Rve::Impl::revert() noexcept {
  exchange();
  settle();
}

void Rve::Impl::give_up(std::uint64_t grain_steps_before) noexcept {
  grain_steps_made += now.state.grain_steps - grain_steps_before;
  revert();
}

void Rve::Impl::settle() noexcept {
  trial.end(now);
  if (resting || fixture.size() > largest_kept_scratch) trial.release();
}

Rve::Impl& Rve::Impl::at_work() {
  if (trial.pending()) revert();
  if (resting) rebuild_buffers(fixture, now);
  resting = false;
  return *this;
}

Rve::Impl& Rve::Impl::up_to_date() {
  at_work();
  if (has_deferred()) guarded([this] { return make_deferred(); });
  return *this;
}

Response Rve::attempt(const Matrix3& displacement_gradient, double dt, const Want& want) {
  Impl& m = impl_->at_work();
  expect_time(dt);
  const CallClock clock(m.fixture.times);
  const FrameSplit split = split_increment(m.now.cell, displacement_gradient);
  const bool deferred = dt == 0 && m.may_defer(split);
  return m.tried(deferred ? Trial::Changes::deferred_strain : Trial::Changes::grains, [&] {
    const Report report = deferred ? m.defer(split) : m.load(split, displacement_gradient, dt);
    return m.respond(report, displacement_gradient, dt, want);
  });
}

Response Rve::apply(const Matrix3& displacement_gradient, double dt, const Want& want) {
  Impl& m = impl_->at_work();
  expect_time(dt);
  const CallClock clock(m.fixture.times);
  const FrameSplit split = split_increment(m.now.cell, displacement_gradient);
  // What is deferred moves no grain and cannot fail: no trial is needed.
  if (dt == 0 && m.may_defer(split)) return m.respond(m.defer(split), displacement_gradient, dt, want);
  return m.guarded(
      [&] { return m.respond(m.load(split, displacement_gradient, dt), displacement_gradient, dt, want); });
}

Response Rve::apply(const MixedTarget& target, double dt, const Want& want) {
  Impl& m = impl_->at_work();
  expect_time(dt);
  const CallClock clock(m.fixture.times);
  Matrix3 gradient = Matrix3::Zero();
  return m.guarded([&] {
    const long deferred = m.make_deferred();
    m.now.state.stress_slope.setZero();
    Report made = m.load(target, dt, gradient);
    made.substeps += deferred;
    return m.respond(made, gradient, dt, want);
  });
}

bool Rve::pending() const { return impl_->trial.pending(); }
bool Rve::resting() const { return impl_->resting; }

void Rve::commit() {
  if (pending()) impl_->settle();
}

void Rve::revert() noexcept {
  if (pending()) impl_->revert();
}

void Rve::exchange() noexcept {
  if (pending()) impl_->exchange();
}

void Rve::rest() {
  Impl& m = *impl_;
  put_masses_into_rows(m.fixture, m.now);
  m.sums = RowSums();
  m.moved();
  m.resting = true;
  if (m.trial.pending()) {
    m.exchange();
    put_masses_into_rows(m.fixture, m.now);  // often the same as those of the trial: released after both
    release_buffers(m.now);
    m.exchange();
    m.other_stress_holds = false;
  } else {
    m.trial.release();
  }
  release_buffers(m.now);
}

Memory Rve::memory() const {
  Memory memory = memory_of(impl_->now);
  for (const auto* sums : {&impl_->sums.translation, &impl_->sums.rotation, &impl_->sums.dashpot})
    memory.working += sums->capacity() * sizeof(double);
  (pending() ? memory.trial : memory.working) += impl_->trial.bytes();
  return memory;
}

}  // namespace rvelab
