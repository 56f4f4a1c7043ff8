// The energy balance as quantities of records: sums of the whole cell since the specimen was first opened, J; NaN if
// the balance is not computed (solver.energy_balance). With elastic_energy_J and kinetic_energy_J it closes
// (solver/README.md).
#pragma once

#include <limits>

#include "rvelab/records/quantity.hpp"

namespace rvelab::records {

inline double booked(const MeasuredState& state, double EnergyTerms::*term) {
  const EnergyTerms* balance = state.rve.energy_balance();
  return balance != nullptr ? balance->*term : std::numeric_limits<double>::quiet_NaN();
}
inline double booked(const MeasuredState& state, double InteractionTerms::*term) {
  const EnergyTerms* balance = state.rve.energy_balance();
  return balance != nullptr ? balance->of_interactions().*term : std::numeric_limits<double>::quiet_NaN();
}

struct BoundaryWork {
  double boundary_work = 0;
  static constexpr QuantityText text{"boundary_work_J", "J", "work of the cell on the grains"};
  static constexpr auto member = &BoundaryWork::boundary_work;
  static double measure(const MeasuredState& state) { return booked(state, &EnergyTerms::boundary_work); }
};

struct FrictionLoss {
  double friction_loss = 0;
  static constexpr QuantityText text{"friction_J", "J", "lost in slip"};
  static constexpr auto member = &FrictionLoss::friction_loss;
  static double measure(const MeasuredState& state) { return booked(state, &EnergyTerms::friction); }
};

struct RollingLoss {
  double rolling_loss = 0;
  static constexpr QuantityText text{"rolling_J", "J", "lost in rolling"};
  static constexpr auto member = &RollingLoss::rolling_loss;
  static double measure(const MeasuredState& state) { return booked(state, &EnergyTerms::rolling); }
};

struct DashpotLoss {
  double dashpot_loss = 0;
  static constexpr QuantityText text{"dashpot_J", "J", "lost in contact dashpots"};
  static constexpr auto member = &DashpotLoss::dashpot_loss;
  static double measure(const MeasuredState& state) { return booked(state, &EnergyTerms::dashpot); }
};

struct LocalDampingLoss {
  double local_damping_loss = 0;
  static constexpr QuantityText text{"local_damping_J", "J", "lost to Cundall's damping"};
  static constexpr auto member = &LocalDampingLoss::local_damping_loss;
  static double measure(const MeasuredState& state) { return booked(state, &EnergyTerms::local_damping); }
};

struct GlobalDampingLoss {
  double global_damping_loss = 0;
  static constexpr QuantityText text{"global_damping_J", "J", "lost to the global viscous term"};
  static constexpr auto member = &GlobalDampingLoss::global_damping_loss;
  static double measure(const MeasuredState& state) { return booked(state, &EnergyTerms::global_damping); }
};

struct LawLoss {
  double law_loss = 0;
  static constexpr QuantityText text{"law_loss_J", "J", "lost at varying tangential stiffness"};
  static constexpr auto member = &LawLoss::law_loss;
  static double measure(const MeasuredState& state) { return booked(state, &EnergyTerms::law_loss); }
};

struct RemovedKinetic {
  double removed_kinetic = 0;
  static constexpr QuantityText text{
      "removed_kinetic_J", "J", "kinetic energy removed when scaled masses change or the mean velocity is taken out"};
  static constexpr auto member = &RemovedKinetic::removed_kinetic;
  static double measure(const MeasuredState& state) { return booked(state, &EnergyTerms::removed_kinetic); }
};

struct ReleasedByBreaking {
  double released_by_breaking = 0;
  static constexpr QuantityText text{"released_by_breaking_J", "J", "released by bonds as they soften and break"};
  static constexpr auto member = &ReleasedByBreaking::released_by_breaking;
  static double measure(const MeasuredState& state) { return booked(state, &InteractionTerms::breaking); }
};

struct ReleasedByForming {
  double released_by_forming = 0;
  static constexpr QuantityText text{"released_by_forming_J", "J",
                                     "released by bridges and adhesion as they form and part"};
  static constexpr auto member = &ReleasedByForming::released_by_forming;
  static double measure(const MeasuredState& state) { return booked(state, &InteractionTerms::forming); }
};

struct GivenByStages {
  double given_by_stages = 0;
  static constexpr QuantityText text{
      "given_by_stages_J", "J", "given to interactions by stages (cement, water, dissolve): change of what they store"};
  static constexpr auto member = &GivenByStages::given_by_stages;
  static double measure(const MeasuredState& state) { return booked(state, &InteractionTerms::stages); }
};

}  // namespace rvelab::records
