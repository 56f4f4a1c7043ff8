#include "rvelab/calibrate/calibrate.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <sstream>
#include <thread>

#include "rvelab/error.hpp"

namespace rvelab {
namespace {

PressureResult evaluate(const TestResult& test, int dimension) {
  const auto records = last_stage(test);
  const Peak highest = peak(records, dimension);
  PressureResult result;
  result.pressure = test.pressure;
  result.peak = highest.stresses;
  result.peak_strain = highest.strain;
  result.friction_angle_deg = friction_angle_deg(highest.stresses);
  result.moving_mean_friction_angle_deg = friction_angle_deg(peak_of_moving_mean(records, dimension));
  result.large_strain_friction_angle_deg = friction_angle_deg(large_strain_mean(records, dimension));
  result.records = records.size();
  result.flagged = static_cast<std::size_t>(
      std::count_if(records.begin(), records.end(), [](const Record& record) { return !record.target_held; }));
  result.wall_seconds = test.wall_seconds;
  result.grain_steps = test.grain_steps;
  return result;
}

/// "p = 10000 Pa" in front of a message.
std::string at_pressure(const Protocol& protocol, const char* message) {
  std::ostringstream text;
  text << "p = " << protocol.pressure << " Pa: " << message;
  return text.str();
}

TestRun run_one(std::size_t number, const Protocol& protocol, const Specimen& specimen, const RunOne& run) {
  try {
    return run ? run(number, protocol, specimen) : run_protocol(protocol, specimen);
  } catch (const InputError& error) {
    throw InputError(at_pressure(protocol, error.what()));
  } catch (const std::exception& error) {
    throw Error(at_pressure(protocol, error.what()));
  }
}

}  // namespace

Calibration calibrate(const std::vector<TestResult>& tests, int dimension) {
  if (tests.empty()) throw InputError("calibrate: 0 tests; allowed: at least 1; give a pressure");
  Calibration result;
  std::vector<PrincipalStresses> peaks;
  for (const auto& test : tests) {
    result.per_pressure.push_back(evaluate(test, dimension));
    const PressureResult& one = result.per_pressure.back();
    peaks.push_back(one.peak);
    result.friction_angle_moving_mean_deg += one.moving_mean_friction_angle_deg / static_cast<double>(tests.size());
    result.large_strain_friction_angle_deg += one.large_strain_friction_angle_deg / static_cast<double>(tests.size());
  }
  result.friction_angle_deg = friction_angle_through_origin_deg(peaks);
  const CohesionFit fit = fit_with_cohesion(peaks);
  result.friction_angle_with_cohesion_deg = fit.friction_angle_deg;
  result.cohesion = fit.cohesion;
  result.bearing_capacity_Nq = bearing_capacity_Nq(result.friction_angle_deg);
  result.local_shear_Nq = local_shear_Nq(result.friction_angle_deg);
  result.wedge_angle_deg = wedge_angle_deg(result.friction_angle_deg);
  return result;
}

void check_calibratable(const Protocol& protocol) {
  const Stage& last = protocol.stages.back();
  const auto* compression = std::get_if<CompressionStage>(&last.what);
  if (compression == nullptr || compression->lateral != CompressionStage::Lateral::constant_stress ||
      compression->to_strain < 0) {
    throw InputError(protocol.path + ": the last stage, \"" + last.name +
                     "\", gives no friction angle; allowed: kind = \"compression\" with lateral = \"constant_stress\" "
                     "and to_strain > 0; calibrate with such a protocol");
  }
  if (!protocol.uses_pressure) {
    throw InputError(protocol.path +
                     ": every stage has a pressure of its own; allowed: at least one that takes test.pressure_Pa, "
                     "which the pressures of a calibration replace; remove pressure_Pa or lateral_pressure_Pa");
  }
}

void check_specimens(const std::vector<Protocol>& protocols, const std::vector<Specimen>& specimens) {
  if (specimens.size() != 1 && specimens.size() != protocols.size()) {
    throw InputError("calibrate: " + std::to_string(specimens.size()) + " specimens for " +
                     std::to_string(protocols.size()) +
                     " pressures; allowed: one for all or one for each; give as many as there are pressures");
  }
}

std::vector<TestRun> run_all(const std::vector<Protocol>& protocols, const std::vector<Specimen>& specimens,
                             unsigned threads, const RunOne& run) {
  check_specimens(protocols, specimens);
  if (threads == 0) threads = std::max(1u, std::thread::hardware_concurrency());
  std::vector<TestRun> runs(protocols.size());
  std::vector<std::exception_ptr> errors(protocols.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t k = next++; k < protocols.size(); k = next++) {
      try {
        runs[k] = run_one(k, protocols[k], specimens[specimens.size() == 1 ? 0 : k], run);
      } catch (...) {
        errors[k] = std::current_exception();
      }
    }
  };
  std::vector<std::thread> workers;
  for (std::size_t k = 0; k < std::min<std::size_t>(threads, protocols.size()); ++k) workers.emplace_back(work);
  for (auto& worker : workers) worker.join();
  for (const auto& error : errors) {
    if (error) std::rethrow_exception(error);
  }
  return runs;
}

}  // namespace rvelab
