// Error of an increment in quasi-static loading: what is allowed, what is to be expected, and the sub-steps that this
// takes.
//
//   allowed = relative max(|d sigma|, 0.1 |C : d eps|) + absolute p      (two tolerances, as ODE solvers have them)
//   error   = K p u,   K = max(1, a/0.3) max(0.4 s^-m, 0.3 + 1.7/(1 + 70 (c - 1)^2)),
//   s = |d sigma|/|C : d eps|,   m = 5/2 in the plane, 7/2 in space
//
// u is the unbalanced ratio at the end of the increment, p the pressure or a thousandth of the reference pressure where
// it is less, C the stiffness of the contact network. This K decides the strain per step; the estimate is measured
// where it can be (error_model.hpp).
//
// - s, the stiffness ratio, is 1 in the elastic range, 0.6 at the peak of a dense biaxial test and 0.4 in flow, where
//   the modes that sliding contacts leave soft follow last. Fitted to increments of 1e-6 to 1e-3 from well-resolved
//   states of the dense packing, forward, back and turned, against 10,000 sub-steps and relaxation: within a factor of
//   two from five sub-steps on, where u alone is off by twenty. In space soft modes follow later: with m = 5/2 62 to
//   72 % of the errors of 1000 spheres in a triaxial test lay within the estimate, with 7/2 87 to 92 %.
// - c is the constraint ratio (assembly/contact_states.hpp): at rest s is 1 whatever the packing, and a packing is soft
//   where few contacts hold a grain. Fitted to 21 packings of discs, spheres and ellipses (1e-7 to 3e-4, three
//   directions): K is 0.19 at c = 2.0, 0.35 at 1.7, 0.5 at 1.3, 1.2 to 1.7 at 1.1, 2.0 at 1.0, within a packing to a
//   factor of 1.4.
// - a is Cundall's damping, 0.3 in all of these: more of it leaves less vibration and more lag in u. Estimate over
// error
//   of a biaxial test at a = 0.1, 0.2, 0.5, 0.7 over that at 0.3: dense 2.1, 1.3, 0.6, 0.44, medium 2.9, 1.5, 0.64,
//   0.48, that is about 0.3/a; below 0.3 it is left at 1, since loose packings err more with weak damping.
#pragma once

#include "rvelab/solver/quasi_static/constants.hpp"

namespace rvelab {

/// |C : d eps|/strain, Pa, of a network of pressure p (Pa) and mean overlap (m) between grains of `diameter` (m):
/// sums of k d^2 over those of f d, for kt/kn = 1/2 (2D 0.75, 3D 0.7), less what the grains give way. `hardening` is
/// the slope of ln f over ln overlap: 1 for linear contacts, 3/2 for Hertz. 0 without contacts.
double network_stiffness(double pressure, double mean_overlap, double diameter, double hardening);

/// Mean overlap over the diameter of a network of that stiffness (Pa): the strain that changes its forces by about as
/// much as they are.
double strain_of_overlap(double pressure, double network_stiffness, double hardening);

/// Pa. `relative` of the larger of the change of stress and a tenth of what the network would answer, and `absolute` of
/// the pressure.
double allowed_error(double relative, double absolute, double stress_change, double elastic_stress_change,
                     double pressure);

/// K above for a stiffness ratio s, c (0: not known), the local damping and the dimension. s is cut to 0.4 .. 1: under
/// stress control flow changes no stress at all, and lags no more than at constant width; c to 1 at least.
double error_per_unbalance(double stiffness_ratio, double constraint_ratio, double damping, int dimension);

/// K of a start from rest, hardly damped: 0.1 + 3/(1 + 70 (c - 1)^2), c the constraint ratio times
/// Model::rolling_constraint_factor.
double error_per_unbalance_of_start(double constraint_ratio);

/// What slow modes still bring after a relaxation, over what its second half brought: 1 + 3/(1 + 70 (c - 1)^2).
double creep_after_relaxation(double constraint_ratio);

/// max(1, x)^(1/8), x the strain of an increment over the mean overlap over d: a long increment has slid contacts by
/// what it lagged on its way. Errors of the 24 increments of x = 3 to 9 were up to 1.2 times the estimate without.
double error_growth(double strain, double strain_of_overlap);

/// Unbalanced ratio that `steps` sub-steps leave of a start: u = m x (1 + 2 x) min(0.45, n^-11/8), x = strain
/// d/overlap, with `strain` that of the increment, `strain_of_overlap` the mean overlap over d, and m the part of the
/// rate that is new: |d eps/n - rate before| n/|d eps|. 1 from rest, 2 for a reversal at the strain per step of before,
/// 0 for the same going on.
double unbalance_of_start(double mismatch, double strain, double strain_of_overlap, double steps);

/// Unbalanced ratio that an increment may have whose error may be `allowed` (Pa), K p being `error_per_ratio` (Pa).
double ratio_for(double allowed, double error_per_ratio);

/// The ratio that a path under stress control may have, whose stress may err by `share` of the pressure, the larger of
/// the two tolerances: where it flows its stress changes by nothing, and a part of that would be no measure. K is at
/// most 4 in the plane and 10 in space.
constexpr double held_path_ratio(double share) { return share / constants::tolerance_over_ratio; }

}  // namespace rvelab
