// What the stress of an increment in quasi-static loading may err by, and is expected to: the formulas of accuracy.hpp
// for a state. Now and then a copy of the state relaxes for some sub-steps and shows by how much its stress lags; in
// between the unbalanced ratio tells, by the factor that was found.
#pragma once

#include "rvelab/solver/state/state.hpp"

namespace rvelab {

/// Whether sub-steps follow from tolerances, not from a given number or unbalanced ratio.
bool by_tolerance(const State& state);

/// That of the sizes of the normal forces, Pa: the mean pressure, and twice the tension that bonds and bridges bear. A
/// cemented specimen in tension, or a moist one without pressure, is no gas.
double pressure(State& state);
/// Of contacts and bonds, |C : d eps|/strain, Pa.
double network_stiffness(State& state);
/// Scale of errors, Pa: the pressure, or a thousandth of the reference where it is less.
double pressure_scale(State& state);
/// |C : d eps| of a strain, Pa.
double elastic_stress_change(const State& state, double strain);
/// Strain that changes the contact forces by about as much as they are; infinite without a network.
double overlap_strain(State& state);

/// By the tolerances of the specimen, Pa; of a change of stress and |C : d eps|, Pa.
double allowed_by_tolerances(State& state, double stress_change, double elastic_change);
/// The same where the stress changes as the path did so far.
double allowed_on_path(State& state, double elastic_change);
/// K, fitted.
double fitted_error_factor(const State& state);
/// K p u for an unbalanced ratio u, Pa.
double expected_error(State& state, double ratio);

/// Unbalanced ratio that an increment of this |C : d eps| (Pa) may have, by tolerance or as given.
double target_ratio(State& state, double elastic_change);
/// The same of a start from rest, by tolerance, whose K is `factor`.
double target_ratio_of_start(State& state, double elastic_change, double factor);
/// K of a start from rest in the elastic range.
double error_factor_of_start(const State& state);
/// That K if the last increment was such a start and was not measured, else 0.
double factor_of_last_start(const State& state);
/// Unbalanced ratio of a path under stress control, and what its stress may err by, over p.
double held_target_ratio(const State& state);
double held_tolerance(const State& state);

/// Sets report.in_equilibrium from its unbalanced ratio and whether its target is held; the target of the ratio is that
/// of the path, at least `least_target_ratio`.
void judge_equilibrium(State& state, Report& report, double least_target_ratio = 0);

/// An increment for which an estimate is made.
struct JudgedIncrement {
  double strain = 0;               ///< of the increment; 0: no sub-step was made for it
  double unbalanced_ratio = 0;     ///< at its end
  double creep_error = 0;          ///< Pa, of a relaxation before a turn that was not complete; adds to the lag
  double extrapolation_error = 0;  ///< Pa, of deferred strain; independent of the others
  double allowed_of_path = 0;      ///< Pa, allowed of an increment that answers as the path did; 0: what is allowed
  double start_error_factor = 0;   ///< K of a start from rest (strain_step.hpp); 0: another increment
  bool events = false;             ///< interactions ended or formed in it (events.hpp)
  double broken_stress = 0;        ///< Pa, that bonds which broke in it bore
};

/// Sets report.error_estimate, allowed_error and tolerance_met, with `allowed` in Pa.
void estimate_error(State& state, double allowed, const JudgedIncrement& increment, Report& report);

/// The same, allowed by the tolerances: `elastic_change` (|C : d eps|, Pa) is that of the path which the increment is a
/// piece of.
void estimate_by_tolerances(State& state, double elastic_change, const Matrix3& stress_before,
                            const JudgedIncrement& increment, Report& report);

/// Adds the error that lags before the end have left: contacts slid elsewhere than in a slower increment. The parts
/// between checks are judged each by its own pressure and stiffness ratio, lag K p u, and their errors add by squares,
/// to each other and to that of the end: lags_left times `path_lag`, Pa, the root of the sum of these squares. Below
/// the strain of the overlaps, x < 1, forces change by the part x, and about that part of the contacts may slide.
void add_error_of_path(State& state, double strain, double path_lag, Report& report);

}  // namespace rvelab
