// What a run is told, and ended, by: a time step that shrinks away, and energy that nothing accounts for.
#pragma once

#include <iosfwd>

#include "tools/mpm/energy.hpp"

namespace mpm {

/// What a run has seen of itself so far.
struct Watched {
  double first_step = 0;  ///< s
  double energy = 0;      ///< J, the largest energy so far: of a balance's terms, or of what the soil stores
  bool told_step = false, told_energy = false;
};

/// Shares of the largest energy so far that may be unaccounted for until it is told, and until the run ends: a mesh of
/// one point a cell, far sheared, comes to 0.15 and 0.2. The n-th step adds of the order of 1/n to them: the balance of
/// free fall has this share from the first step.
inline constexpr double told_share = 0.25, ending_share = 0.5;
/// Parts of the first step at which it is told, and at which the run ends.
inline constexpr double told_step = 1e-3, ending_step = 1e-6;

/// Looks at the step that is to be made (s). std::runtime_error: it is not a number, or below a millionth of the first.
template <int D>
void watch_step(const Solver<D>& solver, double dt, Watched& seen, std::ostream& tell);

/// Looks at the balance. std::runtime_error: what is not accounted for is beyond ending_share.
template <int D>
void watch_energy(const Solver<D>& solver, const EnergyStart& start, Watched& seen, std::ostream& tell);

}  // namespace mpm
