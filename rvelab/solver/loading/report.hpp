// What calls of an Rve answer: the stress and what was done to get it; what an Rve takes in memory.
#pragma once

#include <cstddef>

#include "rvelab/cell/cell.hpp"

namespace rvelab {

/// What was done, and in what state it ended. Of apply and of relax; what a call does not judge keeps its default.
struct Report {
  long substeps = 0;            ///< 0: the strain is left to the next sub-step, see Rve::apply
  long waited = 0;              ///< mixed targets, quasi-static: those of them in which the target stood still
  double unbalanced_ratio = 0;  ///< mean |resultant force|, or mean |torque|/r where larger, over max(mean contact
                                ///< force, 1e-3 of the reference). Quasi-static: when it was
                                ///< measured last: at the end of an increment of 10 sub-steps or more, else up to 50
                                ///< sub-steps before, or what a start since then leaves
  double inertial_number = 0;   ///< at a rate: sqrt(2 e:e) d sqrt(rho/p), infinite at p <= 0; quasi-static: zero
  double held_error = 0;        ///< mixed targets: largest |residual| over its scale (at a rate: of its mean over the
                                ///< increment), see MixedTarget
  bool target_held = true;  ///< mixed targets: held_error <= tolerance; in quasi-static loading always, but with a wait
                            ///< given. relax: the unbalanced ratio that was asked for is reached
  bool in_equilibrium =
      true;                   ///< apply in quasi-static loading: the state is an equilibrium as far as was asked for:
                              ///< the unbalanced ratio is within three times its target and the target is held. A state
                              ///< that flows creeps beyond that: relaxed, its stress falls by some ten times the ratio
  double error_estimate = 0;  ///< quasi-static: of the stress, Frobenius norm, Pa: 19 of 20 errors are below it
  double allowed_error = 0;   ///< quasi-static: relative_tolerance max(|d sigma|, 0.1 |C : d eps|) + absolute_tolerance
                              ///< p, Pa, p at least a thousandth of reference_pressure(). d sigma and d eps since the
                              ///< path turned last, up to 1e-4 of strain, where those are more than the increment's: a
                              ///< path cut finely is the same path. Mixed targets: the larger tolerance times p
  bool tolerance_met = true;  ///< quasi-static: half of the estimate is at most allowed_error: 96 % of the errors are
  bool cell_thin = false;     ///< a cell height is below four mean diameters
};

struct Response {
  Matrix3 stress = Matrix3::Zero();           ///< Cauchy, laboratory frame, tension positive, Pa
  Matrix3 contact_stress = Matrix3::Zero();   ///< of the contact forces
  Matrix3 reynolds_stress = Matrix3::Zero();  ///< quasi-static: zero, but after loading at a rate while only rotated
  Matrix3 displacement_gradient = Matrix3::Zero();  ///< what was applied (mixed targets: what was found)
  Report report;
};

/// Bytes that an RVE holds, without the arrays that its copies share (ids, radii, materials, masses).
struct Memory {
  std::size_t state = 0;    ///< places, velocities, contact histories
  std::size_t list = 0;     ///< neighbour list: pairs, and places when it was built
  std::size_t working = 0;  ///< what Rve::release releases
  std::size_t trial = 0;    ///< what a pending trial takes beside it
};

}  // namespace rvelab
