// Rve::apply, attempt, commit, revert; Rve::rest and the buffers that a state at rest is without. Declared in rve.hpp.
#include <cmath>
#include <sstream>

#include "rvelab/error.hpp"
#include "rvelab/solver/resting.hpp"
#include "rvelab/solver/rve.hpp"
#include "rvelab/solver/rve_impl.hpp"

namespace rvelab {

namespace {

void expect_time(double dt) {
  if (dt >= 0 && std::isfinite(dt)) return;
  std::ostringstream text;
  text << "apply: dt = " << dt << " s; it must be 0 (quasi-static) or a positive time";
  throw InvalidIncrement(text.str());
}

}  // namespace

void Rve::Impl::begin_trial() {
  trial.begin(now);
  other_stress = stress;
  other_stress_holds = stress_holds;
}

void Rve::Impl::exchange() noexcept {
  trial.exchange(now);
  std::swap(stress, other_stress);
  std::swap(stress_holds, other_stress_holds);
  sums_hold = false;
}

void Rve::Impl::revert() noexcept {
  exchange();
  settle();
}

void Rve::Impl::settle() noexcept {
  trial.end(now);
  if (resting || fixture.size() > largest_kept_scratch) trial.release();
}

Rve::Impl& Rve::Impl::awake() {
  if (trial.pending()) revert();
  if (resting) rebuild_buffers(fixture, now);
  resting = false;
  return *this;
}

Response Rve::attempt(const Matrix3& displacement_gradient, double dt, const Want& want) {
  Impl& m = impl_->awake();
  expect_time(dt);
  return m.tried([&] {
    const Report report = m.load(displacement_gradient, dt);
    return m.respond(report, displacement_gradient, dt, want);
  });
}

Response Rve::apply(const Matrix3& displacement_gradient, double dt, const Want& want) {
  const Response response = attempt(displacement_gradient, dt, want);
  impl_->settle();
  return response;
}

Response Rve::apply(const MixedTarget& target, double dt, const Want& want) {
  Impl& m = impl_->awake();
  expect_time(dt);
  Matrix3 gradient = Matrix3::Zero();
  const Report report = m.guarded([&] { return m.load(target, dt, gradient); });
  return m.respond(report, gradient, dt, want);
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
  release_buffers(m.fixture, m.now);
  m.sums = RowSums();
  m.moved();
  m.resting = true;
  if (!m.trial.pending()) {
    m.trial.release();
    return;
  }
  m.exchange();
  release_buffers(m.fixture, m.now);
  m.exchange();
  m.other_stress_holds = false;
}

Memory Rve::memory() const {
  Memory memory = memory_of(impl_->now);
  for (const auto* sums : {&impl_->sums.translation, &impl_->sums.rotation, &impl_->sums.dashpot})
    memory.working += sums->capacity() * sizeof(double);
  (pending() ? memory.trial : memory.working) += impl_->trial.bytes();
  return memory;
}

}  // namespace rvelab
