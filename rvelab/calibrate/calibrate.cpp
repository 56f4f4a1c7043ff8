#include "rvelab/calibrate/calibrate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "rvelab/error.hpp"

namespace rvelab::calibrate {
namespace {

/// The axis of simple shear names a plane.
bool is_simple_shear(const records::TestResult& test) { return test.axis.size() == 2; }

/// Mean stresses at large strain: from 12 to 15 % of a compression; of simple shear over the last 60 % of a
/// strain of 1 or more, which leave the start behind.
PrincipalStresses at_large_strain(const records::TestResult& test, int dimension) {
  const auto records = last_stage(test);
  if (!is_simple_shear(test)) return large_strain_mean(records, dimension);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const double end = std::abs(records.back().strain);
  return end < 1 ? PrincipalStresses{nan, nan} : large_strain_mean(records, dimension, 0.4 * end, end);
}

PressureResult evaluate(const records::TestResult& test, int dimension) {
  const auto records = last_stage(test);
  const Peak highest = peak(records, dimension);
  PressureResult result;
  result.pressure = test.pressure;
  result.simple_shear = is_simple_shear(test);
  result.peak = highest.stresses;
  result.peak_strain = highest.strain;
  result.end_strain = records.back().strain;
  result.rising_at_end = rising_at_end(records, highest);
  result.friction_angle_deg = friction_angle_deg(highest.stresses);
  result.moving_mean_friction_angle_deg = friction_angle_deg(peak_of_moving_mean(records, dimension));
  result.large_strain_friction_angle_deg = friction_angle_deg(at_large_strain(test, dimension));
  result.records = records.size();
  result.flagged = std::size_t(
      std::count_if(records.begin(), records.end(), [](const records::Record& record) { return !record.target_held; }));
  result.wall_seconds = test.wall_seconds;
  result.grain_steps = test.grain_steps;
  return result;
}

}  // namespace

Statistics statistics(const std::vector<double>& values) {
  const auto count = double(values.size());
  Statistics found;
  for (const double value : values) found.mean += value / count;
  double squares = 0;
  for (const double value : values) squares += (value - found.mean) * (value - found.mean);
  found.standard_deviation = std::sqrt(squares / (count - 1));  // one value: 0/0, which is NaN
  found.standard_error = found.standard_deviation / std::sqrt(count);
  return found;
}

namespace {

/// Each specimen by itself, and all of them.
void evaluate_specimens(Calibration& result) {
  std::map<std::size_t, std::vector<PrincipalStresses>> peaks;
  for (const PressureResult& test : result.per_pressure) peaks[test.specimen].push_back(test.peak);
  std::vector<double> angles, factors, Nc, cohesions;
  for (const auto& [specimen, own] : peaks) {
    angles.push_back(strength_angle_deg(own, result.cohesive));
    factors.push_back(bearing_capacity_Nq(angles.back()));
    Nc.push_back(bearing_capacity_Nc(angles.back()));
    cohesions.push_back(fit_with_cohesion(own).cohesion);
    result.per_specimen.push_back({angles.back(), factors.back(), Nc.back(), cohesions.back()});
  }
  result.Nc_of_specimens = statistics(Nc);
  result.cohesion_of_specimens = statistics(cohesions);
  result.friction_angle_of_specimens = statistics(angles);
  result.Nq_of_specimens = statistics(factors);
}

}  // namespace

Calibration calibrate(const std::vector<records::TestResult>& tests, int dimension,
                      const std::vector<std::size_t>& specimens, bool sticks) {
  if (tests.empty()) throw InputError("calibrate: 0 tests; allowed: at least 1; give a pressure");
  Calibration result;
  std::vector<PrincipalStresses> peaks;
  for (std::size_t k = 0; k < tests.size(); ++k) {
    result.per_pressure.push_back(evaluate(tests[k], dimension));
    PressureResult& one = result.per_pressure.back();
    if (!specimens.empty()) one.specimen = specimens.at(k);
    peaks.push_back(one.peak);
    result.friction_angle_moving_mean_deg += one.moving_mean_friction_angle_deg / double(tests.size());
    result.large_strain_friction_angle_deg += one.large_strain_friction_angle_deg / double(tests.size());
  }
  result.cohesive = cohesive(peaks, sticks);
  result.friction_angle_deg = strength_angle_deg(peaks, result.cohesive);
  result.secant_friction_angle_deg = friction_angle_through_origin_deg(peaks);
  const CohesionFit fit = fit_with_cohesion(peaks);
  result.friction_angle_with_cohesion_deg = fit.friction_angle_deg;
  result.cohesion = fit.cohesion;
  result.friction_angle_with_cohesion_error_deg = fit.friction_angle_error_deg;
  result.cohesion_error = fit.cohesion_error;
  result.bearing_capacity_Nq = bearing_capacity_Nq(result.friction_angle_deg);
  result.bearing_capacity_Nc = bearing_capacity_Nc(result.friction_angle_deg);
  result.local_shear_Nq = local_shear_Nq(result.friction_angle_deg);
  result.wedge_angle_deg = wedge_angle_deg(result.friction_angle_deg);
  evaluate_specimens(result);
  return result;
}

bool grains_stick(const Specimen& specimen) {
  if (has_any(specimen)) return true;
  const bool may_stick =
      with_law(specimen.contact.law, [](auto law) { return decltype(law)::Force::has_law_constant; });
  return may_stick && std::any_of(specimen.materials.begin(), specimen.materials.end(), [](const Material& material) {
           return material.adhesion_pressure > 0 || material.pull_off_force > 0;
         });
}

void check_calibratable(const protocol::Protocol& protocol) {
  const protocol::Stage& last = protocol.stages.back();
  if (protocol::role_of(last).gives != protocol::StageRole::Gives::strength) {
    throw InputError(protocol.path + ": the last stage, \"" + last.name + "\", gives no friction angle; allowed: " +
                     protocol::strength_stages() + "; calibrate with such a protocol");
  }
  if (!protocol.uses_pressure) {
    throw InputError(protocol.path +
                     ": every stage has a pressure of its own; allowed: at least one that takes test.pressure_Pa, "
                     "which the pressures of a calibration replace; remove pressure_Pa or lateral_pressure_Pa");
  }
}

void check_specimens(const std::vector<protocol::Protocol>& protocols, const std::vector<Specimen>& specimens) {
  if (specimens.size() != 1 && specimens.size() != protocols.size()) {
    throw InputError("calibrate: " + std::to_string(specimens.size()) + " specimens for " +
                     std::to_string(protocols.size()) +
                     " pressures; allowed: one for all or one for each; give as many as there are pressures, or "
                     "--every-pressure to test each specimen at each of them");
  }
}

}  // namespace rvelab::calibrate
