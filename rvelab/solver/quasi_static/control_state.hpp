// What a quasi-static increment hands to the next, and what the stress servo has learnt.
#pragma once

#include "rvelab/specimen/described.hpp"

namespace rvelab {

/// From one scaling of the masses to the next: what stiffness the network has shown (check.hpp).
struct CheckInterval {
  double strain = 0;                 ///< made in it
  Matrix3 stress = Matrix3::Zero();  ///< when it began, cell frame, Pa
  double network_stiffness = 0;      ///< |C : d eps|/strain then, Pa
};

/// How far the stress lags behind, by the last relaxation of a copy (error_model.hpp).
struct LagMeasurement {
  double error_factor = 0;  ///< K: the lag over p u; 0: not measured yet
  bool grows = false;       ///< the change of stress still grew as it ended
  double strain = 0;        ///< since then
  std::int64_t steps = 0;   ///< sub-steps since then
};

/// Strain that is applied but left to the next sub-step, and the slope that extrapolates the stress (deferred.hpp).
struct DeferredStrain {
  Matrix3 stretch = Matrix3::Identity();   ///< cell frame: the true lattice is this times that of the cell
  Matrix3 stress_slope = Matrix3::Zero();  ///< change of stress over the norm of the strain, last increment, Pa
  double slope_error = 0;                  ///< twice the error of this slope at the next increments, fading by 0.7, Pa
};

struct QuasiStaticControl {
  double strain_per_step = 0;          ///< strain increment per sub-step; 0: not yet known
  double target_unbalanced_ratio = 0;  ///< for which it was chosen
  double unbalanced_ratio = 0;         ///< at the last equilibrium check
  double strain_since_reversal = 0;    ///< up to constants::judged_together
  double stiffness_ratio = 1;          ///< |d sigma|/|C : d eps| of the last interval (accuracy.hpp)
  double constraint_ratio = 0;     ///< constraints of the contacts over the degrees of freedom of the grains that have
                                   ///< any, when the lag was measured last; 0: not known
  bool after_short_start = false;  ///< the last increment was a start from rest too short to be measured
  std::int64_t steps_at_fixed_shape = 0;  ///< sub-steps since the cell last changed its shape
  CheckInterval interval;
  LagMeasurement lag;
  DeferredStrain deferred;
};

/// The stress servo of mixed targets, laboratory frame.
struct ServoState {
  Matrix3 strain = Matrix3::Zero();  ///< integral term, strain per unit of driving strain
  Matrix3 rate = Matrix3::Zero();    ///< loading at a rate: rate of strain of its last update, 1/s
};

namespace fields {

template <>
inline constexpr auto members_of<CheckInterval> = std::tuple{
    Field{"strain", &CheckInterval::strain, "1"}.within(number_from_zero),
    Field{"stress_Pa", &CheckInterval::stress, "Pa"},
    Field{"network_stiffness_Pa", &CheckInterval::network_stiffness, "Pa"}.within(number_from_zero),
};

template <>
inline constexpr auto members_of<LagMeasurement> = std::tuple{
    Field{"error_factor", &LagMeasurement::error_factor, "1"}.within(number_from_zero),
    Field{"grows", &LagMeasurement::grows, "1"},
    Field{"strain", &LagMeasurement::strain, "1"}.within(number_from_zero),
    Field{"steps", &LagMeasurement::steps, "1"}.within(number_from_zero),
};

template <>
inline constexpr auto members_of<DeferredStrain> = std::tuple{
    Field{"stretch", &DeferredStrain::stretch, "1"},
    Field{"stress_slope_Pa", &DeferredStrain::stress_slope, "Pa"},
    Field{"slope_error_Pa", &DeferredStrain::slope_error, "Pa"}.within(number_from_zero),
};

template <>
inline constexpr auto members_of<QuasiStaticControl> = std::tuple{
    Field{"strain_per_step", &QuasiStaticControl::strain_per_step, "1"}.within(number_from_zero),
    Field{"target_unbalanced_ratio", &QuasiStaticControl::target_unbalanced_ratio, "1"}.within(number_from_zero),
    Field{"unbalanced_ratio", &QuasiStaticControl::unbalanced_ratio, "1"}.within(number_from_zero),
    Field{"strain_since_reversal", &QuasiStaticControl::strain_since_reversal, "1"}.within(number_from_zero),
    Field{"stiffness_ratio", &QuasiStaticControl::stiffness_ratio, "1"}.within(number_from_zero),
    Field{"constraint_ratio", &QuasiStaticControl::constraint_ratio, "1"}.within(number_from_zero),
    Field{"after_short_start", &QuasiStaticControl::after_short_start, "1"},
    Field{"steps_at_fixed_shape", &QuasiStaticControl::steps_at_fixed_shape, "1"}.within(number_from_zero),
    Part{"interval", &QuasiStaticControl::interval},
    Part{"lag", &QuasiStaticControl::lag},
    Part{"deferred", &QuasiStaticControl::deferred},
};

template <>
inline constexpr auto members_of<ServoState> = std::tuple{
    Field{"strain", &ServoState::strain, "1"},
    Field{"rate_1_s", &ServoState::rate, "1/s"},
};

}  // namespace fields

}  // namespace rvelab
