#include "rvelab/solver/quasi_static/relaxation.hpp"

#include <algorithm>
#include <optional>

#include "rvelab/solver/quasi_static/accuracy.hpp"
#include "rvelab/solver/quasi_static/constants.hpp"
#include "rvelab/solver/quasi_static/error_model.hpp"
#include "rvelab/solver/quasi_static/quasi_static.hpp"
#include "rvelab/solver/quasi_static/strain_step.hpp"

namespace rvelab {

using namespace constants;

namespace {

constexpr long part = check_interval / 2;  ///< sub-steps of a relaxation between two checks

void advance_fixed_cell(State& state, long steps) {
  const FrameSplit still{Matrix3::Identity(), Matrix3::Identity(), true};
  state.advance({still, steps, 1, Loading::quasi_static});
}

/// By how much the stress of a copy changes within creep_steps at a fixed cell, Pa.
double change_at_rest(State& state) {
  const FrameSplit still{Matrix3::Identity(), Matrix3::Identity(), true};
  Assembly copy = state.assembly();
  const Matrix3 before = contact_virial(state.model(), copy) / copy.cell.volume();
  make_substeps(state.model(), copy, {still, creep_steps, 1, Loading::quasi_static});
  state.count(creep_steps);
  return (contact_virial(state.model(), copy) / copy.cell.volume() - before).norm();
}

}  // namespace

Report relax(State& state, double unbalanced, long max_steps) {
  Report report;
  const long deferred = apply_deferred(state);
  EquilibriumCheck check(state);
  check.prepare();
  state.control().deferred.stress_slope.setZero();
  while (true) {
    check.check();
    report.unbalanced_ratio = state.control().unbalanced_ratio;
    if (report.unbalanced_ratio <= unbalanced || report.substeps >= max_steps) break;
    // The state counts the steps: a relaxation may be made in as many calls as one likes.
    const bool patient = state.control().steps_at_fixed_shape < patience_of_damping;
    const double before = patient ? 0 : kinetic_energy(state.model(), state.assembly());
    const long steps = std::min(part, max_steps - report.substeps);
    advance_fixed_cell(state, steps);
    report.substeps += steps;
    if (!patient && kinetic_energy(state.model(), state.assembly()) < before) state.stop_quasi_static();
  }
  report.target_held = report.unbalanced_ratio <= unbalanced;
  report.substeps += deferred;
  return report;
}

namespace {

/// Error that an increment allows the state before it, Pa; none: it goes on from the state as it is.
std::optional<double> allowed_before(const SolverOptions& o, const CachedRelaxation& s, double strain, bool reverses) {
  const double so_far = s.strain_since_reversal;
  const double path = reverses ? so_far : std::max(strain, std::min(so_far + strain, judged_together));
  const double elastic_change = s.network_stiffness * path;
  const double allowed = allowed_error(o.relative_tolerance, o.absolute_tolerance, s.stiffness_ratio * elastic_change,
                                       elastic_change, s.pressure_scale);
  const double target = s.pressure > 0 ? ratio_for(allowed, s.error_per_ratio) : largest_target;
  if (!reverses && !(s.target_unbalanced_ratio > step_margin * target)) return std::nullopt;
  return allowed;
}

/// Whether it goes on after so many parts.
bool goes_on(const CachedRelaxation& s, std::size_t parts, double allowed) {
  return long(parts) * part < most_steps_before_turn && s.error[parts] > (parts > 0 ? 1 / step_margin : 1) * allowed;
}

}  // namespace

CachedRelaxation inputs_of_relaxation(State& state) {
  const QuasiStaticControl& control = state.control();
  CachedRelaxation s;
  s.rate = state.last_step().rate;
  s.strain_since_reversal = control.strain_since_reversal;
  s.network_stiffness = control.interval.network_stiffness;
  s.stiffness_ratio = control.stiffness_ratio;
  s.target_unbalanced_ratio = control.target_unbalanced_ratio;
  s.pressure = pressure(state);
  s.pressure_scale = pressure_scale(state);
  s.error_per_ratio = expected_error(state, 1);
  return s;
}

Relaxed relax_before(State& state, EquilibriumCheck& check, double strain, bool reverses,
                     CachedRelaxation& relaxation) {
  const std::optional<double> allowed = allowed_before(state.model().options, relaxation, strain, reverses);
  if (!allowed) return {};
  relaxation.error.push_back(expected_error(state, state.control().unbalanced_ratio));
  while (goes_on(relaxation, relaxation.parts(), *allowed)) {
    relaxation.stress.push_back(state.stress());
    advance_fixed_cell(state, part);
    check.check();
    relaxation.error.push_back(expected_error(state, state.control().unbalanced_ratio));
  }
  return relaxed_by(state, relaxation);
}

bool relaxes_alike(const SolverOptions& options, const CachedRelaxation& made, double strain, bool reverses) {
  const std::optional<double> allowed = allowed_before(options, made, strain, reverses);
  if (!allowed) return made.parts() == 0;
  if (made.error.empty()) return false;  // the increment that left it needed no relaxation and measured no error
  std::size_t parts = 0;
  while (parts < made.parts() && goes_on(made, parts, *allowed)) ++parts;
  return parts == made.parts() && !goes_on(made, parts, *allowed);
}

long substeps_of(const CachedRelaxation& made) {
  return long(made.parts()) * part + (made.creep_of_rolling < 0 ? 0 : creep_steps);
}

Relaxed relaxed_by(State& state, CachedRelaxation& made) {
  Relaxed relaxed;
  if (made.parts() == 0) return relaxed;
  relaxed.steps = long(made.parts()) * part;
  relaxed.creep = std::max(creep_after_relaxation(state.control().constraint_ratio) *
                               (state.stress() - made.stress[made.parts() / 2]).norm(),
                           slow_share * (state.stress() - made.stress[0]).norm());
  if (!state.model().contact.rolling) return relaxed;
  // Grains that roll past each other creep on at nearly the same rate long after the others are at rest.
  if (made.creep_of_rolling < 0) made.creep_of_rolling = creep_goes_on * change_at_rest(state);
  relaxed.creep = std::max(relaxed.creep, made.creep_of_rolling);
  return relaxed;
}

}  // namespace rvelab
