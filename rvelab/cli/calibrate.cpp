// rvelab calibrate: one compression test at several pressures, and the strength of the soil from all of them.
#include "rvelab/calibrate/calibrate.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <set>
#include <sstream>

#include "rvelab/cli/commands.hpp"
#include "rvelab/cli/interrupt.hpp"
#include "rvelab/cli/protocol_input.hpp"
#include "rvelab/cli/recording.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/publish.hpp"

namespace rvelab::cli {
namespace {

struct CalibrateArguments {
  std::string protocol, pressures, folder;
  std::vector<std::string> specimens, settings;
  unsigned threads = 0;
  RecordingOptions recording;
  bool json = false;
};

[[noreturn]] void refuse_pressure(const std::string& found) {
  throw InputError("--pressures holds \"" + found +
                   "\"; allowed: numbers > 0 in Pa, apart by commas, each once; write for example 10e3,20e3");
}

/// "10e3,15e3" as numbers.
std::vector<double> parsed_pressures(const std::string& list) {
  std::vector<double> pressures;
  std::istringstream text(list);
  for (std::string item; std::getline(text, item, ',');) {
    double value = 0;
    const auto [end, error] = std::from_chars(item.data(), item.data() + item.size(), value);
    const bool whole = error == std::errc() && end == item.data() + item.size();
    if (!whole || !std::isfinite(value) || value <= 0) refuse_pressure(item);
    pressures.push_back(value);
  }
  if (pressures.empty()) refuse_pressure(list);
  return pressures;
}

/// Name of the record file of one test: the pressure in Pa as an integer.
std::string record_file_name(double pressure) { return "R_" + std::to_string(std::llround(pressure)) + ".h5"; }

std::vector<Protocol> protocols_at(const CalibrateArguments& arguments) {
  const std::string path = protocol_path(arguments.protocol);
  const Protocol general = read_protocol(path, arguments.settings);
  const auto pressures =
      arguments.pressures.empty() ? general.calibration_pressures : parsed_pressures(arguments.pressures);
  if (pressures.empty()) {
    throw InputError(general.path +
                     ": no pressures are given; allowed: --pressures 10e3,20e3 or [calibrate] pressures_Pa; add one");
  }
  std::vector<Protocol> protocols;
  std::set<std::string> names;
  for (const double pressure : pressures) {
    std::ostringstream assignment;
    assignment.precision(17);
    assignment << "test.pressure_Pa=" << pressure;
    if (!names.insert(record_file_name(pressure)).second) refuse_pressure(assignment.str());
    auto settings = arguments.settings;
    settings.push_back(assignment.str());
    protocols.push_back(read_protocol(path, settings));
  }
  check_calibratable(protocols.front());
  return protocols;
}

Json per_pressure(const Calibration& calibration) {
  Json tests = Json::array();
  for (const PressureResult& test : calibration.per_pressure) {
    tests.push_back({{"pressure_Pa", test.pressure},
                     {"peak_sigma_1_Pa", test.peak.major},
                     {"peak_sigma_3_Pa", test.peak.minor},
                     {"peak_strain", test.peak_strain},
                     {"friction_angle_deg", test.friction_angle_deg},
                     {"friction_angle_moving_mean_deg", test.moving_mean_friction_angle_deg},
                     {"large_strain_friction_angle_deg", test.large_strain_friction_angle_deg},
                     {"records", test.records},
                     {"flagged", test.flagged},
                     {"wall_s", test.wall_seconds},
                     {"grain_steps", test.grain_steps}});
  }
  return tests;
}

void report(const Calibration& calibration, const Protocol& protocol, double wall_seconds, bool json) {
  Listing listing;
  unsigned long long grain_steps = 0;
  for (const auto& test : calibration.per_pressure) grain_steps += test.grain_steps;
  listing.add("protocol", protocol.name);
  listing.add("friction_angle_deg", calibration.friction_angle_deg, "degrees");
  listing.add("friction_angle_moving_mean_deg", calibration.friction_angle_moving_mean_deg, "degrees");
  listing.add("friction_angle_with_cohesion_deg", calibration.friction_angle_with_cohesion_deg, "degrees");
  listing.add("cohesion_Pa", calibration.cohesion, "Pa");
  listing.add("large_strain_friction_angle_deg", calibration.large_strain_friction_angle_deg, "degrees");
  listing.add("bearing_capacity_Nq", calibration.bearing_capacity_Nq);
  listing.add("local_shear_Nq", calibration.local_shear_Nq);
  listing.add("wedge_angle_deg", calibration.wedge_angle_deg, "degrees");
  listing.add("per_pressure", per_pressure(calibration));
  listing.add("wall_s", wall_seconds, "s");
  listing.add("grain_steps", grain_steps);
  listing.print(json);
}

/// Says what the stopped tests left, and ends the program with the code of the signal.
[[noreturn]] void end_stopped(const std::vector<TestRun>& runs, const std::string& folder) {
  const auto done = std::count_if(runs.begin(), runs.end(), [](const TestRun& run) { return run.complete; });
  std::cerr << "rvelab: stopped by " << signal_name() << " with " << done << " of " << runs.size()
            << " tests complete; " << (folder.empty() ? "their records are not kept without -o" : "go on with --resume")
            << std::endl;
  throw Stopped(128 + signal_received());
}

void run_calibration(const CalibrateArguments& arguments) {
  const auto begin = std::chrono::steady_clock::now();
  const auto protocols = protocols_at(arguments);
  arguments.recording.expect_output(arguments.folder);
  const auto specimens = specimens_for(protocols.front(), arguments.specimens);
  check_specimens(protocols, specimens);
  std::vector<std::unique_ptr<RecordStore>> stores(protocols.size());
  if (!arguments.folder.empty()) {
    const std::filesystem::path folder = arguments.folder;
    expect_folder_of((folder / "R.h5").string());
    auto inputs = specimen_files(protocols.front(), arguments.specimens);
    inputs.push_back(protocols.front().path);
    for (std::size_t k = 0; k < protocols.size(); ++k) {
      const std::string file = (folder / record_file_name(protocols[k].pressure)).string();
      io::expect_place(file, inputs);
      stores[k] = open_store(file, protocols[k], specimens[specimens.size() == 1 ? 0 : k], arguments.recording);
    }
  }
  Watch watch;
  watch.stop = &stop_on_signals();
  const auto runs = run_all(protocols, specimens, arguments.threads,
                            [&](std::size_t number, const Protocol& protocol, const Specimen& specimen) {
                              return run_recorded(protocol, specimen, stores[number].get(), watch);
                            });
  const bool complete = std::all_of(runs.begin(), runs.end(), [](const TestRun& run) { return run.complete; });
  if (!complete) end_stopped(runs, arguments.folder);
  std::vector<TestResult> results;
  for (const TestRun& run : runs) results.push_back(run.result);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  report(calibrate(results, specimens.front().cell.dimension), protocols.front(), wall.count(), arguments.json);
}

}  // namespace

void add_calibrate(CLI::App& app) {
  auto arguments = std::make_shared<CalibrateArguments>();
  CLI::App* command =
      app.add_subcommand("calibrate", "Run a compression test at several pressures: friction angle, N_q");
  command->add_option("protocol", arguments->protocol, "PROTOCOL.toml, or the name of an installed one: biaxial")
      ->required();
  command->add_option("--specimen", arguments->specimens, "specimen; given several times: one for each pressure")
      ->expected(1)
      ->allow_extra_args(false)
      ->take_all();
  command->add_option("--pressures", arguments->pressures, "Pa, 10e3,15e3,...; else [calibrate] pressures_Pa");
  command->add_option("-o,--output", arguments->folder, "folder for record files R_<pressure>.h5");
  command->add_option("--set", arguments->settings, "key=value, for example contact.slip=consistent")
      ->expected(1)
      ->allow_extra_args(false)
      ->take_all();
  command->add_option("--threads", arguments->threads, "tests at a time; else as many as there are cores")
      ->check(CLI::Range(1u, 4096u));
  arguments->recording.add_to(*command);
  command->add_flag("--json", arguments->json, "print one JSON object");
  command->footer(
      "Examples:\n"
      "  rvelab calibrate biaxial --specimen dense.h5 --pressures 10e3,20e3,30e3\n"
      "  rvelab calibrate biaxial --specimen a.h5 --specimen b.h5 --pressures 10e3,20e3 -o records");
  command->callback([arguments] { run_calibration(*arguments); });
}

}  // namespace rvelab::cli
