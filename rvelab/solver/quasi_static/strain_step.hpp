// The strain increment per step: it follows the unbalanced ratio to the target that the tolerances give. Beside it the
// number of sub-steps that a start or a turn takes.
#pragma once

#include "rvelab/solver/state/state.hpp"

namespace rvelab {

/// Makes the strain per step one for the unbalanced ratio `target`, to which it is proportional.
void set_target_ratio(State& state, double target);

/// After a check: n <- n (u/target)^(3/4). `held_stress` is what a mixed target holds (Servo::held_stress), Pa.
void adapt_strain_step(State& state, const OutOfBalance& balance, double held_stress = 0);

/// Whether the strain per step was one for more than twice the ratio that a path of this |C : d eps| (Pa) may have.
bool was_coarser(State& state, double elastic_change);

/// Sub-steps that an increment of this strain makes at most.
double most_substeps(State& state, double strain);

/// Sub-steps that an increment takes at least, since its rate is not that of the sub-step before, and the unbalanced
/// ratio that they leave.
struct StartUp {
  double substeps = 1, unbalanced_ratio = 0;
  /// K of a start from rest in the elastic range, made in exactly `substeps` sub-steps with little damping; 0: any
  /// other increment, for which `substeps` is a lower bound.
  double start_error_factor = 0;
};
/// `change` is stretch - I, `strain` its Green strain; `elastic_change` (|C : d eps|, Pa) that of the path.
StartUp start_up_of(State& state, const Matrix3& change, double strain, double elastic_change, bool turned_back);

}  // namespace rvelab
