// The constants of quasi-static loading, with what each was measured on; what increments lose without it stands in
// tools/validate.d/results/constants.txt. u is the unbalanced ratio, p the pressure, n a number of sub-steps, x a
// strain over that of the overlaps.
#pragma once

namespace rvelab::constants {

// Equilibrium checks.

/// Sub-steps between checks, for which masses and row sums hold: a check takes the time of five.
constexpr long check_interval = 50;
/// The end of an increment is checked from this n or strain on; shorter ones are judged by what is expected, so that a
/// call of one sub-step makes 2.2 times its instructions (tools/bench/count).
constexpr long checked_steps = 10;
constexpr double checked_strain = 1e-4;
/// Most sub-steps that one increment counts: what a long holds with room (32 bits in WebAssembly).
constexpr double most_steps_counted = sizeof(long) > 4 ? 1e15 : 1e9;
/// Increments that do not reverse are judged together up to this strain: a path cut finely is the same path. A cone of
/// 26 degrees instead of the half space took 1.05 times the sub-steps for the same errors.
constexpr double judged_together = 1e-4;
/// Quasi-static up to this u over its target: 97 % of the checks of a dense biaxial test are within 2.
constexpr double quasi_static_ratio = 3;
/// Least p in a scale of errors, over the reference pressure; u has the same floor. Without it a cell that had come
/// apart took a million sub-steps to start, and 15 of 800 such took 98 % of a biaxial test's time.
constexpr double least_pressure = 1e-3;

// Unbalanced ratio that the tolerances ask for.

/// K p u times this is allowed.
constexpr double step_margin = 2;
/// Part of |C : d eps| that counts as a change of stress at least, so that flow has a relative tolerance.
constexpr double least_change = 0.1;
/// Under stress control peak angles of dense discs are 29.0, 29.2, 29.4 degrees at u = 1e-2, 1e-3 (default) and 1e-4,
/// for 1, 4 and 30 times the time.
constexpr double least_target = 1e-7, largest_target = 2e-3, largest_target_of_held_path = 1e-2;
/// Under stress control u is the tolerance over this: at a tolerance of 0.1, 0.01, 0.003, 0.001 dense discs to 5 % have
/// a mean u of 1.7e-3, 1.1e-3, 3.5e-4, 1.2e-4 for 7, 18, 55, 156 million grain-steps.
constexpr double tolerance_over_ratio = 10;

// Strain increment per step.

/// Mean overlap over the reference one, at least: a reference of another stage says little of a packing that is softer.
constexpr double least_overlap = 0.1;
/// The first over the mean overlap by diameter: a dense packing has u = 2e-4 to 4e-4 at it.
constexpr double first_step_over_overlap = 1e-3, ratio_of_first_step = 3e-4;
/// From check to check it changes by (u/target)^(3/4) within these: of all powers 0.7 was best.
constexpr double least_change_of_step = 0.5, largest_change_of_step = 1.4;
/// The largest changes the overlaps by a hundredth; where no grain touches another there is none.
constexpr double largest_step_over_overlap = 1e-2, step_of_gas = 1e-5;
/// Smallest over largest at a target of 1e-3, in proportion to it down to a quarter: in flow without a network u stays
/// near one at any step. A held stress counts with this part of the reference pressure at least.
constexpr double smallest_over_largest_step = 0.02, per_ratio = 1e3, least_share_of_smallest = 0.25;
constexpr double least_held_share = 1e-4;
/// Part of a sub-step for which no other is made: increments of 1e-5 would take 1.26 times those of 1e-4.
constexpr double rounded_off = 0.25;

// Number of sub-steps.

/// With a given u: with fewer the grains cannot leave the affine motion (1 % of the stress increment takes 20). After a
/// reversal, whose velocities still go on, 20 left 10 % of an increment of 1e-5, 30 4 %, 40 1 %.
constexpr long fewest_steps = 20, fewest_steps_back = 40;
/// The n of a start is searched for by this factor. Its u may be twice the target where the direction goes on: what a
/// change of the step stirs up decays over the increments that follow.
constexpr double growth_of_search = 1.1, onward_allowance = 2;
/// n at most, and for each x: ten times the fewest; tolerances below the defaults take more in proportion.
constexpr double most_steps = 50'000, most_steps_of_overlap = 1000;
/// After a check that finds u below its target, so much of a start's n will do, down to twice check_interval: after a
/// faster path the law of starts asks for up to 4e5 for a strain of 1e-6, where 600 are enough.
constexpr double fewer_after_check = 0.5;
/// n before an increment is refused for what its present step would need: an expansion by a tenth at kn/(p t) = 1e5
/// made 18,482 where the start expected 6e7.
constexpr long settling_steps = 100'000;

// Starts from rest, in the elastic range: hardly damped grains follow in fewer sub-steps.

/// Over the damping and, at most, of the critical step: 400 discs with rolling make an increment of 1e-4 to 1 % in 5
/// sub-steps so, in 10 to 12 with the usual ones.
constexpr double start_damping = 1.0 / 6, start_step = 0.95;
/// K of them (accuracy.hpp): err/(p u) is 0.05 to 0.4 in 90 % at c = 1.5 and more, 2 to 8 at c = 1.
constexpr double firm_factor_of_start = 0.1, isostatic_factor_of_start = 3;
/// The same times this for clumps, whose turns follow later: err/(p u) of 45 starts of the seeds 371 to 400 of
/// rvelab-estimates was up to 3.2 times the estimate without, 2.2 times in 90 %.
constexpr double clump_factor_of_start = 3;
/// K of them up to which grains are held so firmly that a start of some sub-steps is judged by the u that is expected:
/// of packings of c near 1 two of 36 more erred by more than their estimate.
constexpr double firm_error_factor = 0.5;
/// K p u times this is allowed; u at most. With the K, margin and u of other increments a start of 1e-4 takes 76
/// sub-steps instead of 15.
constexpr double start_margin = 1.5, largest_target_of_start = 2e-2;
/// n and x at most (longer ones of spheres were no equilibrium: tests/adapters/test_mgis.py); stiffness ratio at least
/// (errors of starts in flow were up to 2.4 times what may be: tests/solver).
constexpr double longest_start = 50, longest_elastic_strain = 0.3, least_elastic_ratio = 0.8;

// Relaxation.

/// n before a turn at most: 300 to 1,000 take a lag of 1e-2 p to 1e-4 p (random increments in flow).
constexpr long most_steps_before_turn = 2000;
/// What slow modes (n > 3000) keep back of what a relaxation brought, at least: 0.007 to 0.02 in three flowing states
/// of discs, 0.3 and 0.7 in two that roll, which no relaxation of this length shows.
constexpr double slow_share = 0.02;
/// Over what its second half brought: 1 + this/(1 + 70 (c - 1)^2), since soft packings creep on. Of 1,460 such
/// increments of the seeds 501 to 549 of rvelab-estimates 92.7 % were within without, 95.5 % with it; with four times
/// at any c 95.9 %, but dense packings then miss their tolerance by the estimate alone.
constexpr double isostatic_creep = 3;
/// n after which grains are stopped at each peak of the kinetic energy (dynamic relaxation: Cundall 1976; Day 1965):
/// damping by a part of the force hardly takes from modes without stiffness, such as even rings that turn like gears.
constexpr long patience_of_damping = 20'000;

// Error K p u with K fitted (accuracy.hpp).

constexpr double share_of_directions = 0.7;  ///< sums of k d^2 over those of f d, kt/kn = 1/2: 2D 0.75, 3D 0.7
constexpr double stiff_factor = 0.4, least_stiffness_ratio = 0.4;
constexpr double hyperstatic_factor = 0.3, isostatic_factor = 1.7, isostatic_width = 70;
/// u of the first sub-steps of a start, over m x (1 + 2 x).
constexpr double largest_start = 0.45;

// Error with K measured on a copy that relaxes from one check to the next: of 190 random increments this showed 0.9
// to 1.1 of the whole lag for two thirds.

/// n from one measurement to the next, where contacts stay what they are (x < 1 since then) and where they do not.
constexpr long measured_period = 1000, changed_period = 100;

// Estimate of the error.

/// Over the fitted K, where the state was not measured at the end of the increment.
constexpr double fitted_margin = 2.1;
/// A change of stress that grows by this much over the second half of a measurement (2: in proportion to time) is the
/// beginning of a slow one, and so many times as large when that ends: of 46 increments in which it grew errors were up
/// to 30 times the change. Measurements of up to 800 sub-steps gave no more.
constexpr double slow_growth = 1.5, slow_goes_on = 40;
/// Where grains roll: n that a copy relaxes after the relaxation before a turn, and how many times its change of stress
/// is still to come. Of eleven packings that roll two crept at a constant rate, within a factor of two, for 3000 to
/// 6000 sub-steps: with 20 times 73 and 100 % of their errors were within the estimate, with 30 times 91 and 100 %.
constexpr long creep_steps = 200;
constexpr double creep_goes_on = 30;
/// Over what the bonds that broke bore of the stress (the root of the sum of squares): others may break instead, each
/// as likely here as there. Of 30 breaking increments of eight packings 90 % of the errors were within with 1, 97 %
/// with 2.
constexpr double order_of_breaking = 2;
/// Lag of moist grains over that of dry ones: of 98 increments of six packings 94 % were within without, and half of
/// the spreads of those that depend on the last bit.
constexpr double moist_lag = 2;
/// Over the root of the sum of squares of the lags on the way (add_error_of_path). Of 717 increments of 1e-3 to 1e-2 of
/// the seeds 501 to 549, those that depend on the last bit with them, 88.1 % were within with 1, 94.3 % with 2, 96.4 %
/// with 3.
constexpr double lags_left = 3;
/// Added, over what is allowed: resolved answers are no better known.
constexpr double least_share = 0.03;
/// Over what is allowed, up to which a tolerance counts as met: 96 % of 2,363 errors then are (2.4: 95 %).
constexpr double met_margin = 2;

// Deferred strain.

/// Of the allowed error, for the extrapolation; of the strain per step, up to which strain is deferred. A path of 1e-3
/// from rest takes 249, 405, 362 sub-steps in pieces of 1e-4, 1e-6, 1e-7; with a share of 0.4 284, 332 of the last two,
/// but a path that turned erred by 5e-4 p.
constexpr double share_of_extrapolation = 0.3, part_of_step = 0.8;
/// The slope of the stress holds within acos(0.99) = 8 degrees of the path. Its error is twice its last change,
/// remembered with a factor, since slips come in rows: 99.5 % of 33,000 stresses to 6 % of strain lay within (once,
/// none: 94 %).
constexpr double along_path = 0.99, change_of_slope = 2, memory_of_slope = 0.7;

// Stress control (servo.hpp, recovery.hpp).

/// Any proportional gain below one is stable; with these a change of direction settles in some twenty updates.
constexpr double proportional_gain = 0.5, integral_gain = 0.05;
/// n between updates of the servo; contacts that form anew are checked every other time.
constexpr long servo_interval = 5;
/// The answer to stress errors at most, over the strain of a full update.
constexpr double largest_answer = 10;
/// Stiffness that keeps the gain regular in a gas, over that of one typical contact a grain.
constexpr double gas_over_contact = 0.01;
/// Held force over the reference contact force, at least, in the overlap that it is worth.
constexpr double least_held_force = 1e-7;
/// Errors from which the target waits, over its tolerance, and at least: a turn of the loading leaves less, which
/// settles.
constexpr double far_off = 4, least_far_off = 0.02;
/// No network: fewer contacts a grain than any that carries stress, and an error next to the whole.
constexpr double contacts_apart = 2, stress_gone = 0.9;
/// Closing of the cell in a sub-step over the overlaps, and its growth without a network in all (from check to check
/// that of a step): at a tenth of an overlap a sub-step the servo is still in time.
constexpr double closing_over_overlap = 3e-3, most_growth_of_closing = 30;
/// Shear of a wait that is flow: cells that came apart in avalanches closed by 2e-2 at most.
constexpr double shear_of_flow = 0.5;
/// A given wait is this part of the increment's n at least: in stiff packings transients decay as slowly as it is made.
constexpr long share_of_wait = 4;

}  // namespace rvelab::constants
