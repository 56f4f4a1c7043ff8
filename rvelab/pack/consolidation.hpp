// Consolidation: an assembly is brought to a stress and comes to rest there. Far changes go in small increments, then
// rounds of correcting and relaxing follow. Packing and the isotropic stage of a test both use it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>

#include "rvelab/cell/cell.hpp"
#include "rvelab/error.hpp"
#include "rvelab/solver/rve.hpp"

namespace rvelab::pack {

/// A stress to go to. Laboratory frame, Pa, tension positive.
struct StressGoal {
  Matrix3 stress = Matrix3::Zero();  ///< symmetric
  bool shear = true;                 ///< shear components are driven too, the cell shears; false: it keeps its angles
  int dimension = 2;
  double least_pressure = 0;  ///< Pa: increments are a part of it at least, on the way to 0
  double pressure() const;    ///< mean, compression positive, Pa
};

/// Largest distance of a driven component from the goal, Pa.
double largest_gap(const StressGoal& goal, const Matrix3& stress);

/// Where the next increment goes to, on the straight way to the goal: no component further than `largest_change` of the
/// present mean pressure, of a tenth of the goal's, or of goal.least_pressure. The goal itself once that is near
/// enough.
Matrix3 next_stress(const StressGoal& goal, const Matrix3& stress, double largest_change);

/// Sub-steps that an increment waits for its stress: the rounds correct what it misses.
constexpr long short_wait = 200;
constexpr int most_increments = 1000;  ///< on the way to the goal

/// How precisely a state is reached.
struct Rest {
  double stress_tolerance = 1e-4;  ///< of the goal's pressure
  double unbalanced = 1e-5;
  double largest_change = 0.1;
  long max_rounds = 100;
  long max_steps = 100'000;  ///< of one relaxation
};

enum class Consolidated {
  reached,
  far_off,   ///< the increments did not lead to the goal
  not_still  ///< stress or balance is not within its tolerance after the rounds
};

/// Phases of a consolidation, in the order in which it begins; each round is the last two.
enum ConsolidationPhase : std::int32_t { approaching = 2, correcting, relaxing };

/// Consolidates by a `Drive`, which has
///   at                              where it stands: phase, step, stress (Pa), unbalanced_ratio
///   bring(stress, scale, tolerance) one increment to a stress; tolerance relative to the scale (Pa); renews at.stress
///   on_the_way()                    the tolerance of increments on the way
///   relax(unbalanced, max_steps)    at fixed cell; renews at.stress and at.unbalanced_ratio
///   arrived(), pause()              the way is done; a moment at which the consolidation may be left and gone on with
template <class Drive>
Consolidated consolidate(Drive& drive, const StressGoal& goal, const Rest& rest, double pressure) {
  auto& at = drive.at;
  while (at.phase == approaching) {
    const Matrix3 next = next_stress(goal, at.stress, rest.largest_change);
    if ((next - goal.stress).isZero(0)) {
      drive.arrived();
      at.phase = correcting;
      at.step = 0;
      break;
    }
    if (at.step == most_increments) return Consolidated::far_off;
    drive.bring(next, std::max(mean_pressure(at.stress, goal.dimension), 0.1 * pressure), drive.on_the_way());
    ++at.step;
    drive.pause();
  }
  const auto reached = [&] {
    return largest_gap(goal, at.stress) <= rest.stress_tolerance * pressure && at.unbalanced_ratio <= rest.unbalanced;
  };
  while (at.phase == relaxing || (at.step < rest.max_rounds && !reached())) {
    // Half the tolerance: the relaxation that follows moves the stress a little.
    if (at.phase == correcting && largest_gap(goal, at.stress) > 0.5 * rest.stress_tolerance * pressure)
      drive.bring(goal.stress, pressure, 0.5 * rest.stress_tolerance);
    at.phase = relaxing;
    drive.relax(rest.unbalanced, rest.max_steps);
    at.phase = correcting;
    ++at.step;
    drive.pause();
  }
  return reached() ? Consolidated::reached : Consolidated::not_still;
}

/// Sub-steps that a consolidation may make, over all of its calls.
struct StepsLeft {
  long made = 0, most = std::numeric_limits<long>::max();
  std::function<void(long made)> on_spent = {};  ///< called as they are made
};

/// Consolidates an assembly. False: the goal is not reached. `deformation` (F, laboratory frame) is multiplied by that
/// of the cell. NotAtRest once it has made more sub-steps than are left.
bool consolidate(Rve& rve, const StressGoal& goal, const Rest& rest, Matrix3& deformation, StepsLeft* left = nullptr);

/// Grains that do not come to rest; the message says how far they came.
struct NotAtRest : IncrementFailed {
  using IncrementFailed::IncrementFailed;
};

/// "after 100 sub-steps the unbalanced ratio is 0.1 and the stress 0.3 of the pressure off; void ratio 0.2, 3 contacts
/// a grain".
std::string rest_in_words(const Rve& rve, const StressGoal& goal, long substeps);

/// The rotation, as a displacement gradient, that after `deformation` (F) brings material lines that were along the
/// first axis of `frame` back there, and planes of its first two. A shear stress that is driven to zero shears the
/// cell: unless its first vector stays along x, simple shear v_x(y) makes the cell thin in the end.
Matrix3 upright_again(const Matrix3& deformation, const Matrix3& frame);

}  // namespace rvelab::pack
