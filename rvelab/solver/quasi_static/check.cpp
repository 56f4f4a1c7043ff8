#include "rvelab/solver/quasi_static/check.hpp"

#include <algorithm>
#include <cmath>

#include "rvelab/solver/assembly/contact_states.hpp"
#include "rvelab/solver/quasi_static/accuracy.hpp"
#include "rvelab/solver/quasi_static/error_model.hpp"

namespace rvelab {

using namespace constants;

EquilibriumCheck::EquilibriumCheck(State& state) : state_(state) {
  state_.begin_loading(Loading::quasi_static);
  SolverState& control = state_.control();
  unknown_ = control.steps_since_scaling < 0;
  if (!unknown_) return;
  state_.scale_masses();
  control.network_stiffness_ratio = 1;
  control.measured_error_factor = control.strain_since_measurement = 0;
  control.steps_since_measurement = control.steps_at_fixed_shape = 0;
  control.constraint_ratio = constraint_ratio(state_.model(), state_.assembly());
  begin_interval();
}

void EquilibriumCheck::begin_interval() {
  SolverState& control = state_.control();
  const Model& model = state_.model();
  control.steps_since_scaling = 0;
  control.interval_strain = 0;
  control.interval_stress = state_.stress();
  control.network_stiffness =
      network_stiffness(pressure(state_), state_.out_of_balance().mean_overlap, 2 * model.mean_radius, model.hardening);
}

void EquilibriumCheck::renew_interval() {
  SolverState& control = state_.control();
  state_.rescale_masses();
  const double network = network_change(state_, control.interval_strain);
  if (network > 0) {
    const double measured =
        std::clamp((state_.stress() - control.interval_stress).norm() / network, least_stiffness_ratio, 1.0);
    // The geometric mean: stress falls by jumps in flow, and one jump is no stiffness.
    control.network_stiffness_ratio = std::sqrt(control.network_stiffness_ratio * measured);
  }
  begin_interval();
}

const OutOfBalance& EquilibriumCheck::check() {
  const OutOfBalance& balance = state_.checked_balance();
  unknown_ = false;
  state_.note_unbalanced_ratio();
  if (is_due()) renew_interval();
  return balance;
}

bool EquilibriumCheck::is_due() const { return state_.control().steps_since_scaling >= check_interval; }

bool EquilibriumCheck::is_due_at_end(long substeps, double strain) const {
  return unknown_ || is_due() || substeps >= checked_steps || strain > checked_strain;
}

}  // namespace rvelab
