// The two kinds of loading, and what a sub-step of either leaves for the next: units of the velocities, masses, energy.
#pragma once

#include "rvelab/specimen/described.hpp"

namespace rvelab {

/// Quasi-static: scaled masses, no time. At a rate: physical masses and the time that an increment takes.
enum class Loading { quasi_static, at_rate };
template <>
struct Named<Loading> {
  static constexpr const char *key = "loading", *names[] = {"quasi_static", "at_rate"};
};

/// The kind that a step of this time (s) is: none is quasi-static.
constexpr Loading loading_of(double time) { return time > 0 ? Loading::at_rate : Loading::quasi_static; }

/// The last sub-step. Cell frame; a quasi-static sub-step has the length 1.
struct LastStep {
  Loading loading = Loading::quasi_static;  ///< units of the stored velocities (Grains)
  Matrix3 rate = Matrix3::Zero();           ///< D, 1/s or 1/step; dashpot forces need it
  double length = 0;                        ///< s or step
  Vector3 mean_velocity = Vector3::Zero();  ///< mass-weighted mean v', m/s or m/step, which the next step takes out
  Vector3 mean_spin = Vector3::Zero();      ///< axial(W + Omega), rad/s; zero in quasi-static loading
};

/// Masses of quasi-static loading, scaled so that the critical step of each grain is that of the others.
struct ScaledMasses {
  bool in_use = false;                  ///< false: to be scaled before the next quasi-static sub-step
  std::int64_t steps = 0;               ///< sub-steps made with them
  std::vector<double> mass;             ///< N/m, the sub-step being 1; empty while the specimen is open
  std::vector<double> inverse_inertia;  ///< 1/(N m), of the moments of inertia
};

/// What interactions other than contacts release or are given at once, J.
struct InteractionTerms {
  double breaking = 0;  ///< released by bonds as they soften and break
  double forming = 0;   ///< released by bridges and adhesion as they form and part
  double stages = 0;    ///< given by stages that make, change or end interactions: change of what is stored
};

/// Energy balance, J, sums since the specimen was first opened (solver/README.md). Zero if it is not computed.
struct EnergyTerms {
  double boundary_work = 0;
  double friction = 0, rolling = 0, dashpot = 0;
  double local_damping = 0, global_damping = 0;
  double law_loss = 0;         ///< change of f_t^2/2kt at varying kt (Hertz-Mindlin), and M^2/2kr
  double removed_kinetic = 0;  ///< kinetic energy removed when scaled masses change or the mean velocity is taken out
  std::vector<InteractionTerms> interactions;  ///< none (zero), or one row

  /// Adds to one of the terms of interactions. Without any the row does not come to be, so that files stay what they
  /// are.
  void book(double InteractionTerms::*term, double energy) {
    if (energy == 0) return;
    if (interactions.empty()) interactions.emplace_back();
    interactions.front().*term += energy;
  }
  InteractionTerms of_interactions() const { return interactions.empty() ? InteractionTerms{} : interactions.front(); }
};

namespace fields {

template <>
inline constexpr auto members_of<LastStep> = std::tuple{
    Field{"loading", &LastStep::loading, "-"},
    Field{"rate", &LastStep::rate, "1/s or 1/step"},
    Field{"length", &LastStep::length, "s or step"}.within(number_from_zero),
    Field{"mean_velocity", &LastStep::mean_velocity, "m/s or m/step"},
    Field{"mean_spin_rad_s", &LastStep::mean_spin, "rad/s"},
};

template <>
inline constexpr auto members_of<ScaledMasses> = std::tuple{
    Field{"in_use", &ScaledMasses::in_use, "1"},
    Field{"steps", &ScaledMasses::steps, "1"}.within(number_from_zero),
    Field{"mass", &ScaledMasses::mass, "N/m", Rows::per_grain_or_none}.within(positive_number),
    Field{"inverse_inertia", &ScaledMasses::inverse_inertia, "1/(N m)", Rows::per_grain_or_none}.within(
        positive_number),
};

template <>
inline constexpr auto members_of<InteractionTerms> = std::tuple{
    Field{"released_by_breaking_J", &InteractionTerms::breaking, "J"},
    Field{"released_by_forming_J", &InteractionTerms::forming, "J"},
    Field{"given_by_stages_J", &InteractionTerms::stages, "J"},
};
template <>
inline constexpr bool left_out_where_empty<InteractionTerms> = true;

template <>
inline constexpr auto members_of<EnergyTerms> = std::tuple{
    Field{"boundary_work_J", &EnergyTerms::boundary_work, "J"},
    Field{"friction_J", &EnergyTerms::friction, "J"},
    Field{"rolling_J", &EnergyTerms::rolling, "J"},
    Field{"dashpot_J", &EnergyTerms::dashpot, "J"},
    Field{"local_damping_J", &EnergyTerms::local_damping, "J"},
    Field{"global_damping_J", &EnergyTerms::global_damping, "J"},
    Field{"law_loss_J", &EnergyTerms::law_loss, "J"},
    Field{"removed_kinetic_J", &EnergyTerms::removed_kinetic, "J"},
    Table{"interactions", &EnergyTerms::interactions},
};

}  // namespace fields

}  // namespace rvelab
