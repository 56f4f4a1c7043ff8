// Checks of a run that warn, and then end it: a time step that shrinks away, and energy from nothing.
#pragma once

#include <iosfwd>

#include "tools/mpm/step/energy.hpp"

namespace mpm {

/// The first time step, the largest energy, and the warnings of a run so far.
struct Watched {
  double first_step = 0;  ///< s
  double energy = 0;      ///< J, the largest energy so far: of a balance's terms, or of what the soil stores
  bool warned_step = false, warned_energy = false;
};

/// Shares of the largest energy so far that may come from nothing before a warning, and before the run ends; a mesh of
/// one point a cell, far sheared, reaches 0.15 to 0.2. After n steps 4/n are allowed beside: free fall alone has 1/n.
inline constexpr double warning_share = 0.25, ending_share = 0.5;
/// Parts of the first time step at which the run gets a warning, and at which it ends.
inline constexpr double warning_step = 1e-3, ending_step = 1e-6;

/// Checks the time step to be made (s). std::runtime_error: it is not a number, or below ending_step of the first.
template <int D>
void watch_step(const Solver<D>& solver, double dt, Watched& seen, std::ostream& tell);

/// Checks that steps of dt (s), with so many sub-steps of rocks each, lead to the end at `duration` (s).
/// std::runtime_error: they would be more than most_steps; InputError: at the first step.
template <int D>
void watch_length(const Solver<D>& solver, double dt, double sub_steps, double duration);

/// Checks the energy balance. std::runtime_error: more than ending_share comes from nothing.
template <int D>
void watch_energy(const Solver<D>& solver, const EnergyStart& start, Watched& seen, std::ostream& tell);

}  // namespace mpm
