#include "rvelab/solver/quasi_static/relaxation.hpp"

#include <algorithm>
#include <vector>

#include "rvelab/solver/quasi_static/constants.hpp"
#include "rvelab/solver/quasi_static/error_model.hpp"
#include "rvelab/solver/quasi_static/quasi_static.hpp"
#include "rvelab/solver/quasi_static/strain_step.hpp"

namespace rvelab {

using namespace constants;

namespace {

void advance_fixed_cell(State& state, long steps) {
  const FrameSplit still{Matrix3::Identity(), Matrix3::Identity(), true};
  state.advance({still, steps, 1, Loading::quasi_static});
}

/// By how much the stress of a copy changes within creep_steps at a fixed cell, Pa.
double change_at_rest(State& state) {
  const FrameSplit still{Matrix3::Identity(), Matrix3::Identity(), true};
  Assembly copy = state.assembly();
  const Matrix3 before = contact_virial(state.model(), copy) / copy.cell.volume();
  advance(state.model(), copy, {still, creep_steps, 1, Loading::quasi_static});
  state.count(creep_steps);
  return (contact_virial(state.model(), copy) / copy.cell.volume() - before).norm();
}

}  // namespace

Report relax(State& state, double unbalanced, long max_steps) {
  Report report;
  const long deferred = apply_deferred(state);
  EquilibriumCheck check(state);
  state.control().deferred.stress_slope.setZero();
  while (true) {
    check.check();
    report.unbalanced_ratio = state.control().unbalanced_ratio;
    if (report.unbalanced_ratio <= unbalanced || report.substeps >= max_steps) break;
    // The state counts the steps: a relaxation may be made in as many calls as one likes.
    const bool patient = state.control().steps_at_fixed_shape < patience_of_damping;
    const double before = patient ? 0 : kinetic_energy(state.model(), state.assembly());
    const long steps = std::min(check_interval / 2, max_steps - report.substeps);
    advance_fixed_cell(state, steps);
    report.substeps += steps;
    if (!patient && kinetic_energy(state.model(), state.assembly()) < before) state.stop_quasi_static();
  }
  report.target_held = report.unbalanced_ratio <= unbalanced;
  report.substeps += deferred;
  return report;
}

Relaxed relax_before(State& state, EquilibriumCheck& check, double strain, bool turns) {
  const double so_far = state.control().strain_since_reversal;
  const double path = turns ? so_far : std::max(strain, std::min(so_far + strain, judged_together));
  const double elastic_change = elastic_stress_change(state, path);
  Relaxed relaxed;
  if (!turns && !was_coarser(state, elastic_change)) return relaxed;
  const double allowed = allowed_by_tolerances(state, state.control().stiffness_ratio * elastic_change, elastic_change);
  std::vector<Matrix3> stresses;
  while (relaxed.steps < most_steps_before_turn && expected_error(state, state.control().unbalanced_ratio) >
                                                       (relaxed.steps > 0 ? 1 / step_margin : 1) * allowed) {
    stresses.push_back(state.stress());
    advance_fixed_cell(state, check_interval / 2);
    check.check();
    relaxed.steps += check_interval / 2;
  }
  if (relaxed.steps == 0) return relaxed;
  relaxed.creep = std::max((state.stress() - stresses[stresses.size() / 2]).norm(),
                           slow_share * (state.stress() - stresses[0]).norm());
  // Grains that roll past each other creep on at nearly the same rate long after the others are at rest.
  if (state.model().contact.rolling) relaxed.creep = std::max(relaxed.creep, creep_goes_on * change_at_rest(state));
  return relaxed;
}

}  // namespace rvelab
