// The energy balance of an RVE: the change of its energy must equal boundary work less losses.
#pragma once

#include <algorithm>
#include <cmath>

#include "rvelab/measure/measures.hpp"
#include "rvelab/solver/rve.hpp"

namespace rvelab::test {

/// Of the moment that the places belong to, J: kinetic energy is the mean of the half steps before and behind it, the
/// later one made by a copy. `rate` is the velocity gradient, 1/s, laboratory frame. With one half step alone the
/// energy in contact would be off by the work of half a step.
inline double energy_in(const Rve& rve, const Matrix3& rate = Matrix3::Zero()) {
  const Network network = rve.network();
  double kinetic = kinetic_energy(network);
  const SolverState state = rve.specimen().state;
  if (state.last_step.loading == Loading::at_rate && state.last_step.length > 0) {
    Rve next(rve);
    next.apply(rate * state.last_step.length, state.last_step.length);
    kinetic = 0.5 * (kinetic + kinetic_energy(next.network()));
  }
  return kinetic + elastic_energy(network);
}

inline double losses_in(const EnergyTerms& l) {
  const InteractionTerms others = l.of_interactions();
  return (l.friction + l.rolling + l.dashpot + l.local_damping + l.global_damping + l.law_loss + l.removed_kinetic) +
         (others.breaking + others.forming - others.stages);
}

/// From the first evaluation on. SolverOptions::energy_balance must be on.
class EnergyBalance {
 public:
  explicit EnergyBalance(const Rve& rve)
      : rve_(&rve), start_(energy_in(rve)), ledger_(rve.specimen().state.energy_balance) {
    look();
  }

  /// Notes the largest work, change and loss so far: the residual is measured by them.
  void look(const Matrix3& rate = Matrix3::Zero()) {
    const EnergyTerms now = rve_->specimen().state.energy_balance;
    const double work = now.boundary_work - ledger_.boundary_work, loss = losses_in(now) - losses_in(ledger_);
    const double change = energy_in(*rve_, rate) - start_;
    residual_ = change - (work - loss);
    scale_ = std::max({scale_, std::abs(work), std::abs(change), std::abs(loss)});
  }

  /// |dE - (W - L)| over the largest of |W|, |dE|, |L| at any evaluation. NaN stays NaN.
  double residual() const { return residual_ == 0 ? 0 : std::abs(residual_) / scale_; }

 private:
  const Rve* rve_;
  double start_;
  EnergyTerms ledger_;
  double residual_ = 0, scale_ = 0;
};

}  // namespace rvelab::test
