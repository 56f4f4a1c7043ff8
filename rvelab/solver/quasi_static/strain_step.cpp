#include "rvelab/solver/quasi_static/strain_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "rvelab/solver/quasi_static/accuracy.hpp"
#include "rvelab/solver/quasi_static/error_model.hpp"

namespace rvelab {

using namespace constants;

namespace {

/// Mean overlap, m, which control takes for its scale.
double scale_of_overlaps(const State& state, const OutOfBalance& balance) {
  return std::max(balance.mean_overlap, least_overlap * state.reference().overlap);
}

double first_strain_step(State& state) {
  return first_step_over_overlap * scale_of_overlaps(state, state.out_of_balance()) / (2 * state.model().mean_radius);
}

/// How many sub-steps a start needs so that it leaves no more than `target` of imbalance, `steps` at least, and no more
/// than `most` are looked for; `rate` is the strain of the sub-step before it.
double steps_of_start(const Matrix3& change, double strain, const Matrix3& rate, double strain_of_overlap,
                      double target, double steps, double most) {
  const double onward = change.cwiseProduct(rate).sum();
  if (onward > 0) target *= onward_allowance;
  const double norm = change.norm();
  if (!(norm > 0)) return steps;
  while (steps < most) {
    const double mismatch = (change - steps * rate).norm() / norm;
    if (unbalance_of_start(mismatch, strain, strain_of_overlap, steps) <= target) break;
    steps = std::max(steps + 1, std::floor(growth_of_search * steps));
  }
  return steps;
}

}  // namespace

void set_target_ratio(State& state, double target) {
  QuasiStaticControl& control = state.control();
  if (control.strain_per_step == 0) {
    control.strain_per_step = first_strain_step(state);
    control.target_unbalanced_ratio = state.model().options.target_unbalanced > 0 ? target : ratio_of_first_step;
  }
  if (control.target_unbalanced_ratio > 0 && control.target_unbalanced_ratio != target)
    control.strain_per_step = std::clamp(control.strain_per_step * (target / control.target_unbalanced_ratio),
                                         std::numeric_limits<double>::min(), 1.0);
  control.target_unbalanced_ratio = target;
}

void adapt_strain_step(State& state, const OutOfBalance& balance, double held_stress) {
  QuasiStaticControl& control = state.control();
  const double x = state.unbalanced_ratio(balance) / control.target_unbalanced_ratio;
  const double root = std::sqrt(x);  // square roots give the same bits everywhere
  const double factor = std::clamp(root * std::sqrt(root), least_change_of_step, largest_change_of_step);
  const double overlap = scale_of_overlaps(state, balance) / (2 * state.model().mean_radius);
  const double largest = balance.touching > 0 ? largest_step_over_overlap * overlap : step_of_gas;
  const double slow = smallest_over_largest_step * state.model().slip_frequency_ratio *
                      std::clamp(per_ratio * control.target_unbalanced_ratio, least_share_of_smallest, 1.0);
  double smallest = slow * largest;
  // Where a stress is held far below the reference, the overlaps are judged by the stress that is asked for: the
  // reference would let a step be as large as they are, and in an avalanche they vanish, after which one record cost as
  // much as the whole test (730,000 sub-steps).
  if (held_stress > 0 && state.reference().pressure > 0 && balance.touching > 0) {
    const double share = std::clamp(held_stress / state.reference().pressure, least_held_share, 1.0);
    smallest = std::min(smallest, slow * largest_step_over_overlap * share * state.reference().overlap /
                                      (2 * state.model().mean_radius));
  }
  control.strain_per_step = std::clamp(control.strain_per_step / factor, smallest, largest);
}

bool was_coarser(State& state, double elastic_change) {
  return state.control().target_unbalanced_ratio > step_margin * target_ratio(state, elastic_change);
}

double most_substeps(State& state, double strain) {
  if (!by_tolerance(state)) return std::numeric_limits<double>::infinity();
  const SolverOptions& o = state.model().options;
  const double overlaps = strain * 2 * state.model().mean_radius / state.reference().overlap;
  const double strictness = std::max(1.0, std::min(SolverOptions{}.relative_tolerance / o.relative_tolerance,
                                                   SolverOptions{}.absolute_tolerance / o.absolute_tolerance));
  return std::max(strictness * (most_steps + most_steps_of_overlap * overlaps), 1.0);
}

StartUp start_up_of(State& state, const Matrix3& change, double strain, double elastic_change, bool turned_back) {
  const QuasiStaticControl& control = state.control();
  if (!by_tolerance(state)) return {double(turned_back ? fewest_steps_back : fewest_steps), 0};
  if (!(control.interval.network_stiffness > 0)) return {1, 0};
  double overlap = overlap_strain(state);
  const double most = most_substeps(state, strain);
  // Forces that bonds alone bear grow with the strain: no pressure is their scale. At x = 3 a first increment takes 884
  // sub-steps (50,000 by the pressure of none); at x = 2, 501, one that breaks a bond was told ten times its peak.
  if (strain > overlap && has_interactions(state.assembly()) && state.out_of_balance().touching == 0)
    overlap = strain / 3;
  // Stiff grains among soft ones answer as slowly as these: at 1 : 10,000 a start of five sub-steps left u = 0.5.
  const bool elastic = state.model().alike_contacts && control.stiffness_ratio >= least_elastic_ratio &&
                       strain <= longest_elastic_strain * overlap;
  if (elastic && state.last_step().rate.isZero(0) && !turned_back) {
    const double factor = error_factor_of_start(state);
    const double target = target_ratio_of_start(state, elastic_change, factor);
    const double steps = steps_of_start(change, strain, state.last_step().rate, overlap, target, 1, most);
    if (steps <= longest_start) return {steps, unbalance_of_start(1, strain, overlap, steps), factor};
  }
  const double by_strain = std::max(1.0, std::ceil(strain / control.strain_per_step));
  const double steps =
      steps_of_start(change, strain, state.last_step().rate, overlap, control.target_unbalanced_ratio, by_strain, most);
  const double mismatch = (change - steps * state.last_step().rate).norm() / change.norm();
  return {steps, unbalance_of_start(mismatch, strain, overlap, steps)};
}

}  // namespace rvelab
