// Calibration: one compression test at several pressures, and the strength of the soil from all of them.
#pragma once

#include <vector>

#include "rvelab/calibrate/mohr.hpp"
#include "rvelab/protocol/run.hpp"

namespace rvelab::calibrate {

/// Results of one test. Pa, compression positive; degrees.
struct PressureResult {
  double pressure = 0;
  std::size_t specimen = 0;  ///< its number, from 0
  bool simple_shear = false;
  PrincipalStresses peak;
  double peak_strain = 0;
  double end_strain = 0;
  bool rising_at_end = false;                  ///< the largest deviator is at the end: the test shows no peak
  double friction_angle_deg = 0;               ///< of the peak; a secant through the origin, as the next two
  double moving_mean_friction_angle_deg = 0;   ///< of the 1 % moving mean
  double large_strain_friction_angle_deg = 0;  ///< from 12 to 15 %; simple shear: of its last 60 %
  std::size_t records = 0;
  std::size_t flagged = 0;  ///< records whose stress was not held
  double wall_seconds = 0;
  unsigned long long grain_steps = 0;
};

/// Over several specimens. NaN: standard deviation and error of fewer than two, or of values that are not all defined.
struct Statistics {
  double mean = 0;
  double standard_deviation = 0;  ///< of the specimens (divided by their number less one)
  double standard_error = 0;      ///< of the mean
};

/// Results of one specimen: least squares over its peaks, as those of Calibration.
struct SpecimenResult {
  double friction_angle_deg = 0, bearing_capacity_Nq = 0, bearing_capacity_Nc = 0;
  double cohesion = 0;  ///< Pa
};

/// Results of all tests. Degrees, Pa; NaN where the tests do not reach.
struct Calibration {
  Cohesive cohesive = Cohesive::no;
  double friction_angle_deg = 0;                ///< that of N_q: the secant angle, of a cohesive soil the tangent angle
  double secant_friction_angle_deg = 0;         ///< peaks, t = s sin phi through the origin
  double friction_angle_moving_mean_deg = 0;    ///< mean over the tests
  double friction_angle_with_cohesion_deg = 0;  ///< peaks, t = s sin phi + c cos phi
  double cohesion = 0;                          ///< Pa; reported, negative or not
  double friction_angle_with_cohesion_error_deg = 0, cohesion_error = 0;  ///< standard errors of these two
  double large_strain_friction_angle_deg = 0;                             ///< mean over the tests
  /// Of friction_angle_deg.
  double bearing_capacity_Nq = 0, bearing_capacity_Nc = 0, local_shear_Nq = 0, wedge_angle_deg = 0;
  std::vector<PressureResult> per_pressure;
  std::vector<SpecimenResult> per_specimen;  ///< specimens of one recipe with other seeds differ by degrees
  Statistics friction_angle_of_specimens, Nq_of_specimens, Nc_of_specimens, cohesion_of_specimens;
};

/// Mean, standard deviation and standard error of at least one value.
Statistics statistics(const std::vector<double>& values);

/// Evaluates the last stages of finished tests of one dimension. `specimens`: the number, from 0, of the specimen that
/// each test was made on; none: all on one. `sticks`: grains_stick of the specimens. InputError without tests or
/// records.
Calibration calibrate(const std::vector<records::TestResult>& tests, int dimension,
                      const std::vector<std::size_t>& specimens = {}, bool sticks = false);

/// Whether the grains of a specimen stick: it has bonds, broken ones too, or water, or its contacts pull (its law has
/// an adhesion, and a material gives one above 0).
bool grains_stick(const Specimen& specimen);

/// InputError unless the last stage gives a friction angle: compression at constant lateral stress or simple shear at
/// constant normal stress, whose pressure is that of the test.
void check_calibratable(const protocol::Protocol& protocol);

/// InputError unless there is one specimen for all protocols, or one for each.
void check_specimens(const std::vector<protocol::Protocol>& protocols, const std::vector<Specimen>& specimens);

}  // namespace rvelab::calibrate
