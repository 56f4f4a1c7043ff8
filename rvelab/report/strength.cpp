#include "rvelab/report/strength.hpp"

#include <cmath>

#include "rvelab/report/words.hpp"

namespace rvelab::report {
namespace {

using ensemble::nan;
using ensemble::Spread;

const Spread* spread_of(const Results& results, std::size_t set, const std::string& name) {
  for (const ensemble::Row& row : results.summary.rows)
    if (row.group == set && std::isnan(row.pressure) && row.name == name) return &row.spread;
  return nullptr;
}

/// Mean angle at large strain over all tests of the set; NaN if one ends before.
double large_strain_angle(const std::vector<Test>& tests, const std::vector<Kind>& kinds, std::size_t set) {
  std::size_t place = 0;
  while (ensemble::measures()[place].name != "large_strain_friction_angle_deg") ++place;
  double sum = 0;
  int n = 0;
  for (const Kind& kind : kinds)
    if (kind.set == set)
      for (const std::size_t k : kind.of) sum += tests[k].measured[place], ++n;
  return sum / n;
}

std::string angle_in_words(const Spread& spread) {
  return with_its_error(spread.mean, spread.standard_error) + " degrees";
}

}  // namespace

Json strength_of(const std::vector<Test>& tests, const std::vector<Kind>& kinds, const Results& results) {
  Json sets = Json::array();
  const std::vector<std::string> names = names_of_sets(kinds);
  for (std::size_t set = 0; set < names.size(); ++set) {
    const bool cohesive = results.summary.cohesive_groups.at(set) != calibrate::Cohesive::no;
    const Spread* angle =
        spread_of(results, set, cohesive ? "cohesive_friction_angle_deg" : "secant_friction_angle_deg");
    if (angle == nullptr) continue;
    const Spread* cohesion = cohesive ? spread_of(results, set, "cohesion_Pa") : nullptr;
    std::size_t rising = 0, count = 0;
    Json circles = Json::array();
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      if (kinds[k].set != set) continue;
      Json each = Json::array();
      for (const std::size_t row : kinds[k].of) {
        const Test& test = tests[row];
        if (!std::isfinite(test.strength.major)) continue;
        ++count;
        const auto last = calibrate::last_stage(test.recorded.result);
        rising += calibrate::rising_at_end(last, calibrate::peak(last, test.dimension)) &&
                          std::abs(last.back().strain) < 0.15 - 1e-9
                      ? 1
                      : 0;
        each.push_back({number(test.strength.s() / 1e3), number(test.strength.t() / 1e3)});
      }
      if (!each.empty()) circles.push_back({{"kind", k}, {"states", std::move(each)}});
    }
    std::string words =
        (names[set].empty() ? "F" : names[set] + ": f") + std::string("riction angle ") + angle_in_words(*angle);
    if (angle->n > 1)
      words += ", mean and standard error of " + counted(angle->n, "specimen") +
               (angle->n < 3 ? "" : " (95 % interval of the mean " + interval_in_words(angle->low, angle->high) + ")");
    if (cohesion != nullptr)
      words += ", the tangent of a cohesive soil with c = " +
               with_its_error(cohesion->mean / 1e3, cohesion->standard_error / 1e3) + " kPa";
    else
      words += ", a secant through the origin at the largest \u03c3\u2081 \u2212 \u03c3\u2083";
    const double large = large_strain_angle(tests, kinds, set);
    if (std::isfinite(large)) words += "; at large strain " + in_three_digits(large) + " degrees";
    words += ".";
    if (rising > 0)
      words += " " + std::to_string(rising) + " of " + counted(count, "test") +
               " still rose at the end: the angle is a lower bound; run further (to_strain), to 15 % at most.";
    sets.push_back({{"name", names[set]},
                    {"set", set},
                    {"circles", std::move(circles)},
                    {"angle", number(angle->mean)},
                    {"low", number(angle->mean - angle->standard_error)},
                    {"high", number(angle->mean + angle->standard_error)},
                    {"text", angle_in_words(*angle)},
                    {"cohesion_kPa", number(cohesion != nullptr ? cohesion->mean / 1e3 : 0)},
                    {"large_strain", number(large)},
                    {"words", words}});
  }
  return sets;
}

}  // namespace rvelab::report
