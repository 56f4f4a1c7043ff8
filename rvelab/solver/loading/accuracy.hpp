// Error of an increment at dt = 0: what is allowed, what is to be expected, and the sub-steps that this takes.
//
//   allowed = relative max(|d sigma|, 0.1 |C : d eps|) + absolute p      (two tolerances, as ODE solvers have them)
//   error   = K p u,   K = max(1, 0.1 + 3 a) max(0.4 s^-m, 0.3 + 1.7/(1 + 70 (c - 1)^2)),
//   s = |d sigma|/|C : d eps|,   m = 5/2 in the plane, 7/2 in space
//
// u is the unbalanced-force ratio at the end of the increment, p the pressure, C the stiffness of the contact network,
// s how soft the specimen answers beside it: 1 in the elastic range, 0.6 at the peak of a dense biaxial test, 0.4 in
// flow, where the modes that sliding contacts leave soft take longest to follow. Fitted to increments of 1e-6 to 1e-3
// from well-resolved states of the dense packing, forward, back and turned (1 to 2000 sub-steps against 10,000 and
// relaxation): within a factor of two of all beyond five sub-steps; u alone is off by twenty. This K sets the pace; the
// estimate is measured by a rest, where there is one (solver/estimate.cpp).
//
// p is the pressure, or a thousandth of the specimen's own where it is less.
//
// At rest s is 1 whatever the packing, and what is soft is that few contacts hold a grain: c is the number of
// constraints over that of motions, of the grains that two contacts hold at least (1: isostatic). A contact gives 1, d
// - 1 more if it sticks, d - 1 more if it rolls below its limit, both of these times h = mu/(mu + 0.15); a grain has d
// motions, and its turns times the mean h (ellipses: all of them). So nothing jumps where friction begins: at rest
// packings of friction 0.02 to 0.1 have K = 1 to 4, as frictionless ones do. Fitted to 21 packings of discs, spheres
// and ellipses (increments of 1e-7 to 3e-4, three directions): K is 0.19 at c = 2.0, 0.35 at 1.7, 0.5 at 1.3, 1.2
// to 1.7 at 1.1, 2.0 at 1.0, within a packing the same to a factor of 1.4.
//
// In space soft modes follow later still: with m = 5/2 62 to 72 % of the errors of 1000 spheres in a triaxial test lay
// within the estimate, with 7/2 87 to 92 %, for twice the sub-steps and half the error.
//
// a is Cundall's damping, 0.3 in all of these: of a ratio that it leaves more is lag and less vibration. Estimate over
// error on the way of a biaxial test, a = 0.1, 0.2, 0.5, 0.7 over that of 0.3: dense 2.1, 1.3, 0.6, 0.44, medium 2.9,
// 1.5, 0.64, 0.48, that is 1/(0.1 + 3 a). Below 0.3 it is left at 1, since in loose packings a weak damping errs more.
//
// g = max(1, x/0.3)^(3/4), x the strain of the increment over that of the overlap: what a long increment lagged by on
// its way has slid contacts that the end knows nothing of. Of 348 increments of 1e-3 to 1e-2, where x is 0.2 to 2, 79 %
// of the errors lay within an estimate without g, 93 % with it; shorter ones have g = 1.
#pragma once

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
double allowed_error(double relative, double absolute, double stress_change, double network_change, double pressure);

/// K above for a softness s, c (0: not known), the local damping and the dimension. s is cut to 0.4 .. 1: under stress
/// control flow changes no stress at all, and lags no more than at constant width; c to 1 at least.
double error_per_unbalance(double softness, double constraint_ratio, double damping, int dimension);

/// What a contact of this friction that sticks holds across its normal, in constraints: none without friction, one for
/// each direction with much of it. Where friction is low, it slides as soon as the grains move.
double grip_of(double friction);

/// g above, of the strain of an increment and the mean overlap over d.
double error_growth(double strain, double strain_of_overlap);

/// The same beside a rest at the end, which sees more: max(1, x)^(1/8). Errors of the 24 increments of x = 3 to 9 were
/// up to 1.2 times the estimate without.
double rested_growth(double strain, double strain_of_overlap);

/// Unbalanced ratio that `steps` sub-steps leave of a start: u = m x (1 + 2 x) min(0.45, n^-11/8), x = strain
/// d/overlap, with `strain` that of the increment, `strain_of_overlap` the mean overlap over d, and m the part of the
/// rate that is new: |d eps/n - rate before| n/|d eps|. 1 from rest, 2 for a reversal at the pace from before, 0 for
/// the same going on.
double unbalance_of_start(double mismatch, double strain, double strain_of_overlap, double steps);

/// An increment is made so that this many times K p u is what its tolerances allow.
constexpr double pace_margin = 2;

/// Under stress control the path is judged as a whole: where it flows its stress changes by nothing, and a part of that
/// would be no measure. Its stress may err by `share` of the pressure, the larger of the two tolerances; the ratio that
/// such a path may have is share/10, with K at most 4 in the plane and 10 in space.
constexpr double held_path_ratio(double share) { return share / 10; }

/// Constants of estimate and sub-steps, with what they were measured on.
namespace accuracy {

/// Friction at which a contact that sticks counts for half a constraint across its normal.
constexpr double half_grip = 0.15;
/// Sub-steps of a copy at rest: of 190 drawn increments their change was 0.9 to 1.1 of the whole lag for two thirds.
constexpr long rest_steps = 50;
/// What such a rest leaves, over p u.
constexpr double left_by_rest = 1;
/// Where a path rests before it turns, its slowest modes (3000 sub-steps and more) keep back at least this share of
/// what the rest has brought, or what its second half has: 0.007 to 0.02 in three flowing states of discs, 0.3 and 0.7
/// in two that roll, which no rest of this length shows.
constexpr double slow_share = 0.02;
/// Where grains roll: sub-steps that a copy rests after that rest, and how many times their change of stress is still
/// to come. Of eleven packings that roll two crept at a constant rate, within a factor of two, for 3000 to 6000
/// sub-steps: with 20 times 73 and 100 % of their errors were within the estimate, with 30 times 91 and 100 %.
constexpr long creep_steps = 200;
constexpr double creep_goes_on = 30;
/// A change of stress that grows by this much from half of a rest to its end (2: in proportion to time) is the
/// beginning of a slow one, and so many times as large when that ends: of 46 increments in which it grew errors were up
/// to 30 times the change, of 1000 in which it did not 19 of 20 were below 0.8 times. Rests of up to 800 sub-steps told
/// no more.
constexpr double slow_growth = 1.5, slow_goes_on = 40;
/// Sub-steps from one rest of a copy to the next, where contacts stay what they are and where they do not.
constexpr long rest_period = 1000, changed_period = 100;
/// Sub-steps of an increment of strain that has a rest of its own; and of one that has where nothing is known.
constexpr long long_increment = 200, least_increment = 10;
/// The estimate over what a rest has shown: where its change does not grow 95 % of the errors are below 0.8 times.
constexpr double measured_margin = 0.9;
/// Times that where it is the first: grains whose friction was lowered slide on for longer than a path lags (errors up
/// to 1.22 times the estimate without, friction 0 and an increment of 1e-6).
constexpr double first_margin = 1.35;
/// The estimate over g K p u: at least, where an earlier rest has shown more; and where there was none yet.
constexpr double fitted_margin = 2.2, unmeasured_margin = 3;
/// What is added beyond the strain of the overlaps, over K p u sqrt(x), u the mean on the way: errors at x = 70 and
/// friction 0.05 were 6 K p u where the end was calm.
constexpr double way_margin = 1;
/// What is added, over what is allowed: resolved answers are no better known. Beyond the strain of the overlaps a path
/// that was cut otherwise ends elsewhere by so much, however calm.
constexpr double least_share = 0.03, least_share_of_long = 0.1;
/// The estimate over what is allowed, up to which a tolerance counts as met: 96 % of the errors then are (2,363 drawn
/// increments; 2.4: 95 %).
constexpr double met_margin = 2;
/// Sub-steps of an increment at most, and those for each strain of the overlaps: ten times the fewest.
constexpr double most_steps = 50'000, most_steps_of_overlap = 1000;

}  // namespace accuracy

}  // namespace rvelab
