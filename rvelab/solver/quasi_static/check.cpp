#include "rvelab/solver/quasi_static/check.hpp"

#include <algorithm>
#include <cmath>

#include "rvelab/solver/assembly/contact_states.hpp"
#include "rvelab/solver/quasi_static/accuracy.hpp"
#include "rvelab/solver/quasi_static/error_model.hpp"

namespace rvelab {

using namespace constants;

void EquilibriumCheck::prepare() {
  state_.set_loading(Loading::quasi_static);
  QuasiStaticControl& control = state_.control();
  not_yet_checked_ = !state_.masses().in_use;
  if (!not_yet_checked_) return;
  state_.scale_masses();
  control.stiffness_ratio = 1;
  control.lag = {};
  control.steps_at_fixed_shape = 0;
  control.constraint_ratio = constraint_ratio(state_.model(), state_.assembly());
  begin_interval();
}

void EquilibriumCheck::begin_interval() {
  state_.masses().in_use = true;
  state_.masses().steps = 0;
  state_.control().interval = {0, state_.stress(), network_stiffness(state_)};
}

void EquilibriumCheck::renew_interval() {
  QuasiStaticControl& control = state_.control();
  state_.rescale_masses();
  const double elastic_change = elastic_stress_change(state_, control.interval.strain);
  if (elastic_change > 0) {
    const double measured =
        std::clamp((state_.stress() - control.interval.stress).norm() / elastic_change, least_stiffness_ratio, 1.0);
    // The geometric mean: stress falls by jumps in flow, and one jump is no stiffness.
    control.stiffness_ratio = std::sqrt(control.stiffness_ratio * measured);
  }
  begin_interval();
}

const OutOfBalance& EquilibriumCheck::check() {
  const OutOfBalance& balance = state_.checked_balance();
  not_yet_checked_ = false;
  state_.note_unbalanced_ratio();
  if (is_due()) renew_interval();
  return balance;
}

bool EquilibriumCheck::is_due() const { return state_.masses().steps >= check_interval; }

bool EquilibriumCheck::is_due_at_end(long substeps, double strain) const {
  return not_yet_checked_ || is_due() || substeps >= checked_steps || strain > checked_strain;
}

}  // namespace rvelab
