#include "rvelab/solver/at_rate/time_step.hpp"

#include <algorithm>
#include <cmath>

#include "rvelab/error.hpp"
#include "rvelab/solver/at_rate/frequency.hpp"
#include "rvelab/solver/loading/collisions.hpp"

namespace rvelab {

namespace {

void expect_stable(State& s, double step) {
  // Of the springs: the bound with dashpots is several times below where restitution 0.1 errs. The row sums are a bound
  // from one side: YADE's step of its dense packing is 1.26 times theirs and stable.
  RowSums springs = s.row_sums();
  springs.dashpot.clear();
  if (step <= critical_step(s.model(), springs)) return;
  const double limit = 2 / frequency_reached(s.model(), s.assembly());
  if (step <= limit) return;
  throw IncrementFailed("solver.fixed_time_step_s = " + in_words(s.model().options.fixed_time_step) +
                        " s is above the critical step, " + in_words(limit) +
                        " s, of the contacts as they are: energy would come from nowhere; give at most 0.7 of it, or "
                        "0 for steps that follow the contacts");
}

}  // namespace

TimeStep time_step(State& s, const Matrix3& rate, long interval, double dt) {
  const Model& f = s.model();
  const double fixed = f.options.fixed_time_step;
  if (fixed > 0) {
    expect_stable(s, std::min(fixed, dt));
    const Collisions ahead = collisions_ahead(f, s.assembly(), nullptr, false, {rate, double(interval) * fixed, dt});
    return {fixed, interval, ahead.deep};
  }
  double stable = f.options.time_step_factor * critical_step(f, with_floor(s.row_sums(), f));
  // Strong local damping takes (1 - alpha) to (1 + alpha) of the force as the motion turns: at 0.99 an eighth of the
  // energy came from nowhere at the critical step. (2 (1 - alpha))^(3/4): with the root the energy balance is open by
  // 1.7 %.
  const double damping = 2 * (1 - f.damping.local);
  if (damping < 1) stable *= std::sqrt(damping * std::sqrt(damping));
  const double horizon = std::min(double(interval) * stable, dt);
  const Collisions ahead = collisions_ahead(f, s.assembly(), &s.row_sums(), true, {rate, horizon, dt});
  const double longest = std::min(stable, ahead.step);
  const double steps = std::clamp(std::ceil(ahead.look / longest), 10.0, double(interval));
  return {longest, long(steps), ahead.deep};
}

}  // namespace rvelab
