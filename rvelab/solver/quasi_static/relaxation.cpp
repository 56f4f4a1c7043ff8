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

void advance_fixed_cell(State& s, long steps) {
  const FrameSplit still{Matrix3::Identity(), Matrix3::Identity(), true};
  s.advance({still, steps, 1, Loading::quasi_static});
}

/// By how much the stress of a copy changes within creep_steps at a fixed cell, Pa.
double change_at_rest(State& s) {
  const FrameSplit still{Matrix3::Identity(), Matrix3::Identity(), true};
  Assembly copy = s.assembly();
  const Matrix3 before = contact_moment(s.model(), copy) / copy.cell.volume();
  advance(s.model(), copy, {still, creep_steps, 1, Loading::quasi_static});
  s.count(creep_steps);
  return (contact_moment(s.model(), copy) / copy.cell.volume() - before).norm();
}

}  // namespace

Report relax(State& s, double unbalanced, long max_steps) {
  Report report;
  const long deferred = make_deferred(s);
  EquilibriumCheck check(s);
  s.control().stress_slope.setZero();
  while (true) {
    check.check();
    report.unbalanced_ratio = s.control().unbalanced_ratio;
    if (report.unbalanced_ratio <= unbalanced || report.substeps >= max_steps) break;
    // The state counts the steps: a relaxation may be made in as many calls as one likes.
    const bool patient = s.control().steps_at_fixed_shape < patience_of_damping;
    const double before = patient ? 0 : kinetic_energy(s.model(), s.assembly());
    const long steps = std::min(relaxation_interval, max_steps - report.substeps);
    advance_fixed_cell(s, steps);
    report.substeps += steps;
    if (!patient && kinetic_energy(s.model(), s.assembly()) < before) s.stop_quasi_static();
  }
  report.target_held = report.unbalanced_ratio <= unbalanced;
  report.substeps += deferred;
  return report;
}

Relaxed relax_before(State& s, EquilibriumCheck& check, double strain, bool turns) {
  const double so_far = s.control().strain_since_reversal;
  const double path = turns ? so_far : std::max(strain, std::min(so_far + strain, judged_together));
  const double network = network_change(s, path);
  Relaxed relaxed;
  if (!turns && !was_coarser(s, network)) return relaxed;
  const double allowed = allowed_by_tolerances(s, s.control().network_stiffness_ratio * network, network);
  std::vector<Matrix3> stresses;
  while (relaxed.steps < most_steps_before_turn &&
         expected_error(s, s.control().unbalanced_ratio) > (relaxed.steps > 0 ? 1 / step_margin : 1) * allowed) {
    stresses.push_back(s.stress());
    advance_fixed_cell(s, relaxation_interval);
    check.check();
    relaxed.steps += relaxation_interval;
  }
  if (relaxed.steps == 0) return relaxed;
  relaxed.creep =
      std::max((s.stress() - stresses[stresses.size() / 2]).norm(), slow_share * (s.stress() - stresses[0]).norm());
  // Grains that roll past each other creep on at nearly the same rate long after the others are at rest.
  if (s.model().contact.rolling) relaxed.creep = std::max(relaxed.creep, creep_goes_on * change_at_rest(s));
  return relaxed;
}

}  // namespace rvelab
