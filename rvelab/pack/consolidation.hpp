// Bringing an assembly to a stress: far changes in small increments, then rounds of relaxing and correcting.
#pragma once

#include <functional>
#include <vector>

#include "rvelab/solver/rve.hpp"

namespace rvelab::pack {

/// A stress to go to. Laboratory frame, Pa, tension positive.
struct StressGoal {
  Matrix3 stress = Matrix3::Zero();  ///< symmetric
  bool shear = true;                 ///< shear components are driven too, the cell shears; false: it keeps its angles
  int dimension = 2;
  double pressure() const;  ///< mean, compression positive, Pa
};

/// Largest distance of a driven component from the goal, Pa.
double largest_gap(const StressGoal& goal, const Matrix3& stress);

/// Where the next increment goes to, on the straight way to the goal: no component further than `largest_change` of the
/// present mean pressure, or of a tenth of the goal's. The goal itself once that is near enough.
Matrix3 next_stress(const StressGoal& goal, const Matrix3& stress, double largest_change);

/// Sub-steps that an increment waits for its stress: what it misses the rounds correct.
constexpr long short_wait = 200;

/// How precisely a state is reached.
struct Rest {
  double stress_tolerance = 1e-4;  ///< of the goal's pressure
  double unbalanced = 1e-5;
  double largest_change = 0.1;
  long max_rounds = 100;
  long max_steps = 100'000;  ///< of one relaxation
};

/// Drives an assembly to the goal and lets it come to rest there. False: not reached within the rounds. `deformation`
/// (F, laboratory frame) goes on by what the cell did.
bool consolidate(Rve& rve, const StressGoal& goal, const Rest& rest, Matrix3& deformation);

/// The rotation, as a displacement gradient, that after `deformation` (F) brings material lines that were along the
/// first axis of `frame` back there, and planes of its first two. A shear stress that is driven to zero shears the
/// cell: unless its first vector stays along x, simple shear v_x(y) makes the cell thin in the end.
Matrix3 upright_again(const Matrix3& deformation, const Matrix3& frame);

}  // namespace rvelab::pack
