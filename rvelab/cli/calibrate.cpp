// rvelab calibrate: one compression test at several pressures, and the strength of the soil from all of them.
// Declared in command.hpp.
#include "rvelab/calibrate/calibrate.hpp"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <sstream>

#include "rvelab/cli/columns.hpp"
#include "rvelab/cli/command.hpp"
#include "rvelab/cli/ensemble.hpp"
#include "rvelab/cli/protocol_input.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/cli/sharing.hpp"
#include "rvelab/cli/warnings.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/hdf5/schema.hpp"
#include "rvelab/io/publish.hpp"

namespace rvelab::cli {

namespace {

struct CalibrateArguments {
  std::string folder;
  std::optional<std::string> pressures, tension;
  std::vector<std::string> specimens, more;
  bool every_pressure = false;
  TestOptions test;
};

/// The tests to run. Each has its protocol (the given one at its pressure) and the number of its specimen.
struct Plan {
  std::vector<protocol::Protocol> protocols;
  std::vector<std::size_t> specimen_of;
  std::vector<std::string> files;  ///< names of the record files
  std::size_t compressions = 0;    ///< the tests after these are in tension, one of each specimen

  void add(const protocol::Protocol& protocol, std::size_t specimen, std::string file) {
    protocols.push_back(protocol);
    specimen_of.push_back(specimen);
    files.push_back(std::move(file));
  }
  std::string name(std::size_t test, bool several_specimens) const {
    const std::string pressure = test < compressions ? "p = " + in_words(protocols[test].pressure) + " Pa" : "tension";
    return several_specimens ? "specimen " + std::to_string(specimen_of[test] + 1) + ", " + pressure : pressure;
  }
};

[[noreturn]] void refuse_pressure(const std::string& found) {
  throw InputError("--pressures holds \"" + found +
                   "\"; allowed: numbers from 0 in Pa, apart by commas, each once; write for example 10e3,20e3");
}

/// "10e3,15e3" as numbers.
std::vector<double> parsed_pressures(const std::string& list) {
  std::vector<double> pressures;
  std::istringstream text(list);
  for (std::string item; std::getline(text, item, ',');) {
    double value = 0;
    const auto [end, error] = std::from_chars(item.data(), item.data() + item.size(), value);
    const bool whole = error == std::errc() && end == item.data() + item.size();
    if (!whole || !std::isfinite(value) || value < 0) refuse_pressure(item);
    pressures.push_back(value);
  }
  if (pressures.empty()) refuse_pressure(list);
  return pressures;
}

/// Name of the record file of one test: the pressure in Pa as an integer.
std::string record_file_name(double pressure) { return "R_" + std::to_string(std::llround(pressure)) + ".h5"; }

std::vector<protocol::Protocol> protocols_at(const CalibrateArguments& arguments) {
  const std::string path = protocol_path(arguments.test.protocol);
  const protocol::Protocol general = protocol::read_protocol(path, arguments.test.settings);
  const auto pressures = arguments.pressures ? parsed_pressures(*arguments.pressures) : general.calibration_pressures;
  if (pressures.empty()) {
    throw InputError(general.path +
                     ": no pressures are given; allowed: --pressures 10e3,20e3 or [calibrate] pressures_Pa; add one");
  }
  std::vector<protocol::Protocol> protocols;
  std::set<std::string> names;
  for (const double pressure : pressures) {
    TextStream assignment;
    assignment.precision(17);
    assignment << "test.pressure_Pa=" << pressure;
    if (!names.insert(record_file_name(pressure)).second) {
      throw InputError((arguments.pressures ? "--pressures" : "[calibrate] pressures_Pa") + std::string(" holds ") +
                       in_words(pressure) + " Pa twice, to the pascal; allowed: each pressure once; leave one out");
    }
    auto settings = arguments.test.settings;
    settings.push_back(assignment.str());
    protocols.push_back(protocol::read_protocol(path, settings));
  }
  calibrate::check_calibratable(protocols.front());
  return protocols;
}

/// Every specimen at every pressure where that was asked for or there is one pressure; else one for each, or one for
/// all.
Plan plan_of(const std::vector<protocol::Protocol>& at_pressures, const std::vector<Specimen>& specimens,
             bool every_pressure) {
  const bool cross = every_pressure || at_pressures.size() == 1;
  if (!cross) calibrate::check_specimens(at_pressures, specimens);
  Plan plan;
  for (std::size_t s = 0; s < (cross ? specimens.size() : 1); ++s) {
    for (std::size_t k = 0; k < at_pressures.size(); ++k) {
      const std::size_t specimen = cross ? s : specimens.size() == 1 ? 0 : k;
      std::string file = record_file_name(at_pressures[k].pressure);
      if (cross && specimens.size() > 1) file.insert(file.size() - 3, "_" + std::to_string(s + 1));
      plan.add(at_pressures[k], specimen, file);
    }
  }
  plan.compressions = plan.protocols.size();
  return plan;
}

/// A test in tension of each specimen that the plan has.
void add_tension(const CalibrateArguments& arguments, std::size_t specimens, Plan& plan) {
  if (!arguments.tension) return;
  const protocol::Protocol tension = protocol::read_protocol(protocol_path(*arguments.tension));
  const auto used = std::set<std::size_t>(plan.specimen_of.begin(), plan.specimen_of.end());
  for (const std::size_t specimen : used)
    plan.add(tension, specimen, specimens > 1 ? "T_" + std::to_string(specimen + 1) + ".h5" : "T.h5");
}

/// What tests in tension and without lateral stress give beside the line, and what of it the line would give.
struct TensionAndUnconfined {
  std::vector<double> tensile;  ///< Pa, strength of each specimen
  double unconfined = std::numeric_limits<double>::quiet_NaN();
};

TensionAndUnconfined beside_the_line(const std::vector<records::TestResult>& tension,
                                     const calibrate::Calibration& calibration, int dimension) {
  TensionAndUnconfined found;
  for (const records::TestResult& test : tension)
    found.tensile.push_back(calibrate::tensile_strength(calibrate::last_stage(test), dimension));
  std::vector<double> strengths;
  for (const calibrate::PressureResult& test : calibration.per_pressure)
    if (test.pressure == 0) strengths.push_back(test.peak.major);
  if (!strengths.empty()) found.unconfined = calibrate::statistics(strengths).mean;
  return found;
}

void add_beside_the_line(const TensionAndUnconfined& found, const calibrate::Calibration& calibration,
                         Listing& listing) {
  if (std::isfinite(found.unconfined)) listing.add("unconfined_strength_Pa", found.unconfined, "Pa");
  if (found.tensile.empty()) return;
  const calibrate::Statistics tensile = calibrate::statistics(found.tensile);
  const double apex = calibrate::apex_tension(calibration.friction_angle_with_cohesion_deg, calibration.cohesion);
  listing.add("tensile_strength_Pa", tensile.mean, "Pa");
  if (found.tensile.size() > 1) listing.add("tensile_strength_standard_error_Pa", tensile.standard_error, "Pa");
  listing.add_or_why("tension_at_apex_Pa", apex, "Pa", "the straight envelope has no apex in tension");
  if (apex > 0)
    listing.add("tensile_cut_off", "the soil bears " + in_words(std::round(1e3 * tensile.mean / apex) / 1e3) +
                                       " of the tension c cot(phi) at which the straight envelope ends" +
                                       (tensile.mean < apex ? ": cut it off at sigma_3 = -tensile_strength_Pa" : ""));
}

Json per_pressure(const calibrate::Calibration& calibration) {
  Json tests = Json::array();
  for (const calibrate::PressureResult& test : calibration.per_pressure) {
    tests.push_back({{"pressure_Pa", test.pressure},
                     {"specimen", test.specimen + 1},
                     {"peak_sigma_1_Pa", test.peak.major},
                     {"peak_sigma_3_Pa", test.peak.minor},
                     {"peak_strain", test.peak_strain},
                     {"end_strain", test.end_strain},
                     {"rising_at_end", test.rising_at_end},
                     {"friction_angle_deg", test.friction_angle_deg},
                     {"secant_friction_angle_deg", test.friction_angle_deg},
                     {"friction_angle_moving_mean_deg", test.moving_mean_friction_angle_deg},
                     {"large_strain_friction_angle_deg", test.large_strain_friction_angle_deg},
                     {"records", test.records},
                     {"flagged", test.flagged},
                     {"wall_s", test.wall_seconds},
                     {"grain_steps", test.grain_steps}});
  }
  return tests;
}

/// Mean and scatter over specimens; a single one has none.
void add_statistics(const calibrate::Calibration& calibration, const std::vector<std::string>& files,
                    Listing& listing) {
  listing.add("specimens", calibration.per_specimen.size());
  if (calibration.per_specimen.size() < 2) return;
  const std::string why = calibration.cohesive == calibrate::Cohesive::no
                              ? "a specimen has no friction angle, see per_specimen"
                              : "of a cohesive soil each specimen needs tests at two pressures or more";
  const auto add = [&](const std::string& stem, const std::string& end, const calibrate::Statistics& found,
                       const std::string& unit) {
    listing.add_or_why(stem + "_mean" + end, found.mean, unit, why);
    listing.add_or_why(stem + "_standard_deviation" + end, found.standard_deviation, unit, why);
    listing.add_or_why(stem + "_standard_error" + end, found.standard_error, unit, why);
  };
  add("friction_angle", "_deg", calibration.friction_angle_of_specimens, "degrees");
  add("bearing_capacity_Nq", "", calibration.Nq_of_specimens, "");
  if (calibration.cohesive != calibrate::Cohesive::no) {
    add("bearing_capacity_Nc", "", calibration.Nc_of_specimens, "");
    add("cohesion", "_Pa", calibration.cohesion_of_specimens, "Pa");
  }
  Json rows = Json::array();
  for (std::size_t k = 0; k < calibration.per_specimen.size(); ++k) {
    const calibrate::SpecimenResult& one = calibration.per_specimen[k];
    rows.push_back({{"specimen", k + 1},
                    {"file", files[k]},
                    {"friction_angle_deg", one.friction_angle_deg},
                    {"bearing_capacity_Nq", one.bearing_capacity_Nq},
                    {"bearing_capacity_Nc", one.bearing_capacity_Nc},
                    {"cohesion_Pa", one.cohesion}});
  }
  listing.add_to_json("per_specimen", std::move(rows));
}

/// One line a test; the rest stands in --json.
std::string tests_table(const calibrate::Calibration& calibration) {
  std::vector<std::vector<std::string>> rows{{"specimen", "pressure, Pa", "secant angle", "at strain, %",
                                              "large strain", "sigma_1, kPa", "sigma_3, kPa", "flagged"}};
  const auto angle = angle_in_digits;
  for (const calibrate::PressureResult& test : calibration.per_pressure) {
    rows.push_back({std::to_string(test.specimen + 1), in_words(test.pressure), angle(test.friction_angle_deg),
                    in_digits(100 * test.peak_strain, 3), angle(test.large_strain_friction_angle_deg),
                    in_digits(test.peak.major / 1e3, 4), in_digits(test.peak.minor / 1e3, 4),
                    std::to_string(test.flagged) + " of " + std::to_string(test.records)});
  }
  return aligned(rows);
}

std::string percent(double strain) { return in_words(100 * std::abs(strain)) + " %"; }

/// A warning that names the tests whose largest deviator is at their end; empty if all passed a peak.
std::string without_peak(const calibrate::Calibration& calibration) {
  std::string tests;
  double end = 0;
  std::size_t count = 0;
  for (const calibrate::PressureResult& test : calibration.per_pressure) {
    if (!test.rising_at_end) continue;
    ++count;
    tests += tests.empty() ? "" : ", ";
    if (calibration.per_specimen.size() > 1) tests += "specimen " + std::to_string(test.specimen + 1) + " at ";
    tests += in_words(test.pressure) + " Pa";
    end = std::max(end, std::abs(test.end_strain));
  }
  if (tests.empty()) return "";
  if (count > 3) tests = std::to_string(count) + " of " + std::to_string(calibration.per_pressure.size()) + " tests";
  return tests + ": still rising at the end: no peak; the angle is that of the largest deviator up to " + percent(end) +
         " strain; let the tests go further (to_strain)";
}

/// What is said of the cohesion; "" where there is nothing to say.
std::string cohesion_in_words(const calibrate::Calibration& found) {
  using calibrate::Cohesive;
  const bool beyond_error = found.cohesion > calibrate::cohesive_errors * found.cohesion_error;
  const std::string line =
      "c = " + in_words(std::round(found.cohesion)) + " Pa" +
      (std::isfinite(found.cohesion_error) ? " +- " + in_words(std::round(found.cohesion_error)) : "");
  const auto degrees = [](double angle) { return in_words(std::round(10 * angle) / 10) + " degrees"; };
  if (found.cohesive == Cohesive::no)
    return beyond_error ? "the straight envelope has " + line +
                              ", beyond its error but below 5 % of the mean stress: "
                              "taken as cohesionless, N_q by the secant angle through the origin"
                        : "";
  const std::string why = found.cohesive == Cohesive::by_law
                              ? "the grains stick (bonds, water, or adhesion of the contact law)"
                              : "c is beyond twice its standard error and beyond 5 % of the mean stress";
  if (!std::isfinite(found.friction_angle_with_cohesion_deg))
    return "cohesive: " + why + "; N_q needs the straight envelope, of tests at two pressures or more";
  return "cohesive: " + why + ", " + line +
         "; N_q, N_c and the wedge take the tangent angle of the straight envelope, " +
         degrees(found.friction_angle_with_cohesion_deg) + "; the secant angle through the origin, " +
         degrees(found.secant_friction_angle_deg) + ", counts c as friction and falls as the pressure rises";
}

/// Why a result is not defined, for each that may not be.
struct Reasons {
  std::string peak, secant, moving_mean, cohesion, cohesion_error, large_strain;
};

Reasons reasons_of(const calibrate::Calibration& calibration) {
  double end = std::numeric_limits<double>::infinity();
  bool tension = false;
  for (const calibrate::PressureResult& test : calibration.per_pressure) {
    end = std::min(end, std::abs(test.end_strain));
    tension = tension || !(test.peak.minor > 0);
  }
  const std::string no_angle =
      tension ? "at a peak the minor principal stress is 0 or in tension, which friction alone cannot carry"
              : "the peaks give no angle: no principal stress is in compression";
  const std::string line =
      calibration.per_pressure.size() < 2 ? "needs tests at two pressures or more" : "the peaks lie on no line";
  const bool is_cohesive = calibration.cohesive != calibrate::Cohesive::no;
  return {is_cohesive ? "the soil is cohesive: " + line : no_angle,
          no_angle,
          tension ? no_angle : "needs records over 1 % of strain; a test ends at " + percent(end),
          line,
          calibration.per_pressure.size() < 3 ? "needs tests at three pressures or more" : "the peaks lie on no line",
          std::string(calibration.per_pressure.front().simple_shear
                          ? "is the mean of the last 60 % of a strain of 1 or more; a test ends at "
                          : "is the mean from 12 to 15 % of strain; a test ends at ") +
              percent(end)};
}

void report_calibration(const calibrate::Calibration& calibration, const TensionAndUnconfined& beside,
                        const std::string& protocol, const std::vector<std::string>& specimens, double wall_seconds,
                        bool json) {
  Listing listing;
  unsigned long long grain_steps = 0;
  for (const auto& test : calibration.per_pressure) grain_steps += test.grain_steps;
  const Reasons why = reasons_of(calibration);
  listing.add("protocol", protocol);
  listing.add_or_why("friction_angle_deg", calibration.friction_angle_deg, "degrees", why.peak);
  listing.add_or_why("secant_friction_angle_deg", calibration.secant_friction_angle_deg, "degrees", why.secant);
  listing.add_or_why("friction_angle_moving_mean_deg", calibration.friction_angle_moving_mean_deg, "degrees",
                     why.moving_mean);
  listing.add_or_why("friction_angle_with_cohesion_deg", calibration.friction_angle_with_cohesion_deg, "degrees",
                     why.cohesion);
  listing.add_or_why("friction_angle_with_cohesion_standard_error_deg",
                     calibration.friction_angle_with_cohesion_error_deg, "degrees", why.cohesion_error);
  listing.add_or_why("cohesion_Pa", calibration.cohesion, "Pa", why.cohesion);
  listing.add_or_why("cohesion_standard_error_Pa", calibration.cohesion_error, "Pa", why.cohesion_error);
  listing.add_or_why("large_strain_friction_angle_deg", calibration.large_strain_friction_angle_deg, "degrees",
                     why.large_strain);
  listing.add_or_why("bearing_capacity_Nq", calibration.bearing_capacity_Nq, "", why.peak);
  listing.add_or_why("bearing_capacity_Nc", calibration.bearing_capacity_Nc, "", why.peak);
  if (calibration.cohesive != calibrate::Cohesive::no)
    listing.add_or_why("bearing_capacity_of_cohesion_Pa", calibration.cohesion * calibration.bearing_capacity_Nc, "Pa",
                       why.peak);
  listing.add_or_why("local_shear_Nq", calibration.local_shear_Nq, "", why.peak);
  listing.add_or_why("wedge_angle_deg", calibration.wedge_angle_deg, "degrees", why.peak);
  listing.add("cohesive", calibration.cohesive != calibrate::Cohesive::no);
  if (const std::string text = cohesion_in_words(calibration); !text.empty()) listing.add("cohesion", text);
  add_beside_the_line(beside, calibration, listing);
  add_statistics(calibration, specimens, listing);
  if (const std::string warning = without_peak(calibration); !warning.empty()) listing.add("warning", warning);
  listing.add_to_json("per_pressure", per_pressure(calibration));
  listing.add("wall_s", wall_seconds, "s");
  listing.add("grain_steps", grain_steps);
  listing.print(json);
  if (!json) std::cout << "\n" << tests_table(calibration) << std::flush;
}

/// summary.json and summary.csv beside the records.
void keep_summary(const std::string& folder, const Plan& plan, const std::vector<std::string>& files,
                  const std::vector<records::TestResult>& results, int dimension, bool sticks) {
  const Ensemble ensemble{plan.protocols, files, std::vector<std::size_t>(files.size(), 0), {"specimens"}};
  std::vector<ensemble::TestOf> tests;
  for (std::size_t k = 0; k < results.size(); ++k)
    tests.push_back(test_of(plan.protocols[k], results[k], dimension, 0, plan.specimen_of[k], sticks));
  write_summary(folder, ensemble, tests, ensemble::summary_of(tests), {});
}

/// The tests of a plan, with the files of their records where these are kept.
std::vector<RecordedTest> recorded(const Plan& plan, const std::vector<Specimen>& specimens, const std::string& folder,
                                   const std::vector<std::string>& inputs) {
  std::vector<RecordedTest> tests;
  for (std::size_t k = 0; k < plan.protocols.size(); ++k) {
    const Specimen& specimen = specimens[plan.specimen_of[k]];
    tests.push_back({{plan.name(k, specimens.size() > 1), &plan.protocols[k], [&specimen] { return specimen; }}, ""});
    warn_of_units(plan.protocols[k].path, protocol::unusual_in(plan.protocols[k], specimen));
  }
  if (folder.empty()) return tests;
  for (std::size_t k = 0; k < tests.size(); ++k)
    protocol::with_overrides(plan.protocols[k], specimens[plan.specimen_of[k]]);  // mistakes, before a file is touched
  make_folder(folder);
  for (std::size_t k = 0; k < tests.size(); ++k) {
    tests[k].file = (std::filesystem::path(folder) / plan.files[k]).string();
    io::expect_place(tests[k].file, inputs);
  }
  return tests;
}

void run_calibration(const CalibrateArguments& arguments) {
  const auto begin = std::chrono::steady_clock::now();
  const auto at_pressures = protocols_at(arguments);
  const protocol::Protocol& general = at_pressures.front();
  arguments.test.expect_output(arguments.folder);
  const auto given = files_of(arguments.specimens, arguments.more);
  const auto specimens = specimens_for(general, given);
  const auto files = specimen_files(general, given);
  std::vector<std::uint32_t> digests;
  for (const Specimen& specimen : specimens) {
    if (!arguments.every_pressure && at_pressures.size() > 1) break;  // one for each pressure
    digests.push_back(io::digest(specimen));
    expect_another(files, digests);
  }
  Plan plan = plan_of(at_pressures, specimens, arguments.every_pressure);
  add_tension(arguments, specimens.size(), plan);
  auto inputs = files;
  inputs.push_back(general.path);
  const auto tests = recorded(plan, specimens, arguments.folder, inputs);
  std::vector<records::TestResult> results(plan.compressions), tension(tests.size() - plan.compressions);
  std::atomic<bool> sticks{false};
  const auto failures =
      run_tests(tests, arguments.test, Opening::all_first, [&](std::size_t k, protocol::TestRun&& run) {
        if (calibrate::grains_stick(run.end_state)) sticks = true;
        (k < plan.compressions ? results[k] : tension[k - plan.compressions]) = std::move(run.result);
      });
  if (!failures) return;
  for (const std::string& failure : *failures)
    if (!failure.empty()) throw Error(failure);
  const std::vector<std::size_t> specimen_of(plan.specimen_of.begin(),
                                             plan.specimen_of.begin() + long(plan.compressions));
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  const int dimension = specimens.front().cell.dimension;
  if (!arguments.folder.empty()) keep_summary(arguments.folder, plan, files, results, dimension, sticks);
  const calibrate::Calibration calibration = calibrate::calibrate(results, dimension, specimen_of, sticks);
  report_calibration(calibration, beside_the_line(tension, calibration, dimension), general.name, files, wall.count(),
                     arguments.test.json);
}

}  // namespace

void add_calibrate(CLI::App& app) {
  CLI::App& command = *app.add_subcommand(
      "calibrate", "Run a compression test at several pressures: friction angle, cohesion, N_q, N_c");
  const auto arguments = std::make_shared<CalibrateArguments>();
  command
      .add_option("--specimen", arguments->specimens,
                  "specimen, or \"S_*.h5\"; several: one for each pressure, or all at the one\n"
                  "pressure; with --every-pressure each at all pressures")
      ->allow_extra_args(false);
  command.add_option("--pressures", arguments->pressures, "in Pa, 10e3,15e3,...; default: [calibrate] pressures_Pa");
  command.add_option(
      "--tension", arguments->tension,
      "also this test in tension of each specimen, direct_tension for\nexample: tensile strength, cut-off");
  command.add_flag("--every-pressure", arguments->every_pressure, "test each specimen at every pressure");
  command.add_option(
      "-o,--output", arguments->folder,
      "folder for the record files R_<pressure>.h5, summary.json and\nsummary.csv; made if it is missing");
  arguments->test.add_to(command, "contact.slip=consistent", "tests at a time");
  command.add_option("specimens", arguments->more, "further specimens");
  command.footer(
      "secant_friction_angle: phi with sin phi = (sigma_1 - sigma_3)/(sigma_1 + sigma_3) at the peak, the record with\n"
      "the largest sigma_1 - sigma_3; over several tests by least squares through the origin.\n"
      "..._with_cohesion: the tangent angle, of the straight envelope of the peaks t = s sin phi + c cos phi, with\n"
      "standard errors of phi and c.\n"
      "friction_angle: the secant angle; of a cohesive soil the tangent angle. A soil is cohesive if its grains stick\n"
      "(bonds, water, an adhesion above 0), or if c is above twice its standard error and above 5 % of the mean stress "
      "of the "
      "peaks.\n"
      "bearing_capacity_Nq: N_q = tan^2(45 + phi/2) exp(pi tan phi) of friction_angle, the factor of a footing's\n"
      "surcharge in general shear; bearing_capacity_Nc: N_c = (N_q - 1) cot phi, that of its cohesion;\n"
      "bearing_capacity_of_cohesion: c N_c, what a strip footing on the surface bears without weight and surcharge;\n"
      "local_shear_Nq: N_q with 2/3 tan phi, for loose soil; wedge_angle_deg: 45 + phi/2, angle of the active wedge\n"
      "below a footing against the horizontal.\n"
      "--pressures 0,...: the test at 0 Pa is the unconfined compression, of bonded grains. tensile_strength "
      "(--tension):\n"
      "the largest tension of the minor stress; tension_at_apex: c cot phi, where the straight envelope ends.\n"
      "Specimens with other seeds differ by some degrees; test several. For two or more, calibrate prints mean,\n"
      "standard deviation and standard error of phi and N_q.\n"
      "Examples:\n"
      "  rvelab calibrate biaxial --specimen dense.h5 --pressures 10e3,20e3,30e3\n"
      "  rvelab calibrate biaxial --specimen a.h5 --specimen b.h5 --pressures 10e3,20e3 -o records\n"
      "  rvelab calibrate biaxial --specimen S_1.h5 --specimen S_2.h5 --specimen S_3.h5 --every-pressure\n"
      "  rvelab calibrate biaxial --specimen cemented.h5 --pressures 0,20e3,40e3 --tension direct_tension\n"
      "  mpirun -np 8 rvelab calibrate biaxial 'S_*.h5' --every-pressure -o D --share");
  command.callback([arguments] { run_calibration(*arguments); });
}

}  // namespace rvelab::cli
