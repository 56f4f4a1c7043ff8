#include "rvelab/ensemble/summary.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace rvelab::ensemble {
namespace {

/// What a specimen's strengths give, in the order of names().
struct Strength {
  std::string name, unit;
};

const std::vector<Strength>& strengths() {
  static const std::vector<Strength> all{{"secant_friction_angle_deg", "degrees"},
                                         {"cohesive_friction_angle_deg", "degrees"},
                                         {"cohesion_Pa", "Pa"},
                                         {"bearing_capacity_Nq", ""},
                                         {"bearing_capacity_Nc", ""},
                                         {"bearing_capacity_Ngamma", ""},
                                         {"local_shear_Nq", ""},
                                         {"wedge_angle_deg", "degrees"},
                                         {"spiral_ratio", ""}};
  return all;
}

std::vector<double> strengths_of(const std::vector<calibrate::PrincipalStresses>& peaks, calibrate::Cohesive cohesive) {
  const double angle = calibrate::strength_angle_deg(peaks, cohesive);
  calibrate::CohesionFit fit{nan, nan, nan, nan};
  if (peaks.size() > 1) fit = calibrate::fit_with_cohesion(peaks);
  return {calibrate::friction_angle_through_origin_deg(peaks),
          fit.friction_angle_deg,
          fit.cohesion,
          calibrate::bearing_capacity_Nq(angle),
          bearing_capacity_Nc(angle),
          bearing_capacity_Ngamma(angle),
          calibrate::local_shear_Nq(angle),
          calibrate::wedge_angle_deg(angle),
          spiral_ratio(angle)};
}

/// Adds a row, unless no test gives the value.
void add(Summary& summary, std::size_t group, double pressure, const std::string& name, const std::string& unit,
         const std::vector<double>& values) {
  Row row{group, pressure, name, unit, spread_of(values)};
  if (row.spread.n > 0) summary.rows.push_back(std::move(row));
}

void add_measures(Summary& summary, const std::vector<TestOf>& tests, std::size_t group) {
  std::vector<double> pressures;  // in the order of the tests
  for (const TestOf& test : tests)
    if (std::find(pressures.begin(), pressures.end(), test.pressure) == pressures.end())
      pressures.push_back(test.pressure);
  for (const double pressure : pressures) {
    for (std::size_t k = 0; k < measures().size(); ++k) {
      std::vector<double> values;
      for (const TestOf& test : tests)
        if (test.group == group && test.pressure == pressure) values.push_back(test.values.at(k));
      add(summary, group, pressure, measures()[k].name, measures()[k].unit, values);
    }
  }
}

void add_strengths(Summary& summary, const std::vector<TestOf>& tests, std::size_t group) {
  std::map<std::size_t, std::vector<calibrate::PrincipalStresses>> peaks;
  std::vector<calibrate::PrincipalStresses> all;
  bool sticks = false;
  for (const TestOf& test : tests) {
    if (test.group != group || !std::isfinite(test.strength.major)) continue;
    peaks[test.specimen].push_back(test.strength);
    all.push_back(test.strength);
    sticks = sticks || test.grains_stick;
  }
  summary.cohesive_groups.push_back(calibrate::cohesive(all, sticks));
  std::vector<std::vector<double>> values(strengths().size());
  for (const auto& [specimen, own] : peaks) {
    const std::vector<double> found = strengths_of(own, summary.cohesive_groups.back());
    for (std::size_t k = 0; k < found.size(); ++k) values[k].push_back(found[k]);
  }
  for (std::size_t k = 0; k < values.size(); ++k)
    add(summary, group, nan, strengths()[k].name, strengths()[k].unit, values[k]);
}

bool same(const Row& one, const Row& other) {
  const bool same_pressure = one.pressure == other.pressure || (std::isnan(one.pressure) && std::isnan(other.pressure));
  return one.name == other.name && same_pressure;
}

}  // namespace

Summary summary_of(const std::vector<TestOf>& tests) {
  Summary summary;
  std::size_t groups = 0;
  for (const TestOf& test : tests) groups = std::max(groups, test.group + 1);
  for (std::size_t group = 0; group < groups; ++group) {
    add_measures(summary, tests, group);
    add_strengths(summary, tests, group);
  }
  for (const Row& one : summary.rows) {
    for (const Row& other : summary.rows) {
      if (one.group == 0 && other.group == 1 && same(one, other))
        summary.comparisons.push_back({one.pressure, one.name, one.unit, difference_of(one.spread, other.spread)});
    }
  }
  return summary;
}

}  // namespace rvelab::ensemble
