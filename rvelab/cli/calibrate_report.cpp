#include "rvelab/cli/calibrate_report.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

#include "rvelab/cli/columns.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/error.hpp"

namespace rvelab::cli {
namespace {

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
  const std::string why = "a specimen has no friction angle, see per_specimen";
  const auto add = [&](const std::string& stem, const std::string& end, const calibrate::Statistics& found,
                       const std::string& unit) {
    listing.add_or_why(stem + "_mean" + end, found.mean, unit, why);
    listing.add_or_why(stem + "_standard_deviation" + end, found.standard_deviation, unit, why);
    listing.add_or_why(stem + "_standard_error" + end, found.standard_error, unit, why);
  };
  add("friction_angle", "_deg", calibration.friction_angle_of_specimens, "degrees");
  add("bearing_capacity_Nq", "", calibration.Nq_of_specimens, "");
  Json rows = Json::array();
  for (std::size_t k = 0; k < calibration.per_specimen.size(); ++k) {
    const calibrate::SpecimenResult& one = calibration.per_specimen[k];
    rows.push_back({{"specimen", k + 1},
                    {"file", files[k]},
                    {"friction_angle_deg", one.friction_angle_deg},
                    {"bearing_capacity_Nq", one.bearing_capacity_Nq}});
  }
  listing.add_to_json("per_specimen", std::move(rows));
}

/// One line a test; the rest stands in --json.
std::string tests_table(const calibrate::Calibration& calibration) {
  std::vector<std::vector<std::string>> rows{{"specimen", "pressure, Pa", "peak angle", "at strain, %", "large strain",
                                              "sigma_1, Pa", "sigma_3, Pa", "flagged"}};
  const auto angle = [](double value) { return std::isnan(value) ? "-" : in_words(std::round(100 * value) / 100); };
  for (const calibrate::PressureResult& test : calibration.per_pressure) {
    rows.push_back({std::to_string(test.specimen + 1), in_words(test.pressure), angle(test.friction_angle_deg),
                    in_words(100 * test.peak_strain), angle(test.large_strain_friction_angle_deg),
                    in_words(std::round(test.peak.major)), in_words(std::round(test.peak.minor)),
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

/// Why a result is not defined, for each that may not be.
struct Reasons {
  std::string peak, moving_mean, cohesion, cohesion_error, large_strain;
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
  return {no_angle, tension ? no_angle : "needs records over 1 % of strain; a test ends at " + percent(end),
          calibration.per_pressure.size() < 2 ? "needs tests at two pressures or more" : "the peaks lie on no line",
          calibration.per_pressure.size() < 3 ? "needs tests at three pressures or more" : "the peaks lie on no line",
          std::string(calibration.per_pressure.front().simple_shear
                          ? "is the mean of the last 60 % of a strain of 1 or more; a test ends at "
                          : "is the mean from 12 to 15 % of strain; a test ends at ") +
              percent(end)};
}

}  // namespace

void report_calibration(const calibrate::Calibration& calibration, const std::string& protocol,
                        const std::vector<std::string>& specimens, double wall_seconds, bool json) {
  Listing listing;
  unsigned long long grain_steps = 0;
  for (const auto& test : calibration.per_pressure) grain_steps += test.grain_steps;
  const Reasons why = reasons_of(calibration);
  listing.add("protocol", protocol);
  listing.add_or_why("friction_angle_deg", calibration.friction_angle_deg, "degrees", why.peak);
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
  listing.add_or_why("local_shear_Nq", calibration.local_shear_Nq, "", why.peak);
  listing.add_or_why("wedge_angle_deg", calibration.wedge_angle_deg, "degrees", why.peak);
  add_statistics(calibration, specimens, listing);
  if (const std::string warning = without_peak(calibration); !warning.empty()) listing.add("warning", warning);
  listing.add_to_json("per_pressure", per_pressure(calibration));
  listing.add("wall_s", wall_seconds, "s");
  listing.add("grain_steps", grain_steps);
  listing.print(json);
  if (!json) std::cout << "\n" << tests_table(calibration) << std::flush;
}

}  // namespace rvelab::cli
