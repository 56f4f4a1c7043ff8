// Cyclic resistance: the stress ratio over the number of cycles until liquefaction.
//
//   CSR = q/(2 p_0) of a compression, tau/sigma_0 of simple shear, the amplitude at which it reverses
//   N: cycles until r_u = 0.95, or until a single amplitude of 2.5 % of strain (rvelab/ensemble/cyclic.hpp)
//   CSR = a N^-b      least squares of ln CSR in ln N over the tests of a density that take a cycle at least
//                     (Idriss and Boulanger 2008: b = 0.34 of clean sand)
// CSR at 15 cycles (an earthquake of magnitude 7.5) and at 20 (Japanese practice) is given where the tests come within
// 1.5 times that number.
#include <algorithm>
#include <cmath>
#include <map>

#include "rvelab/ensemble/measures.hpp"
#include "rvelab/sheet/groups.hpp"

namespace rvelab::sheet {
namespace {

constexpr const char* cyclic_group = "Cyclic resistance";
constexpr const char* idriss = "Idriss and Boulanger 2008";

struct Criterion {
  const char *measure, *words;
  About exponent, at_15, at_20;
};
constexpr Criterion criteria[] = {
    {"cycles_to_r_u_0.95",
     "a pore pressure ratio of 0.95",
     {cyclic_group, "cyclic_exponent_ru", "exponent b, to r_u = 0.95", "", "CSR = a N\u207b\u1d47", idriss},
     {cyclic_group, "CSR_15_ru", "CSR at 15 cycles, to r_u = 0.95", "", "by the fitted power law", idriss},
     {cyclic_group, "CSR_20_ru", "CSR at 20 cycles, to r_u = 0.95", "", "by the fitted power law", "Toki et al. 1986"}},
    {"cycles_to_2.5_percent",
     "2.5 % of strain",
     {cyclic_group, "cyclic_exponent_strain", "exponent b, to 2.5 %", "", "CSR = a N\u207b\u1d47, single amplitude",
      idriss},
     {cyclic_group, "CSR_15_strain", "CSR at 15 cycles, to 2.5 %", "", "by the fitted power law", idriss},
     {cyclic_group, "CSR_20_strain", "CSR at 20 cycles, to 2.5 %", "", "by the fitted power law", "Toki et al. 1986"}}};

/// CSR over N of the tests that come so far; `at`: N.
Readings resistances_of(const std::vector<TestGroup>& groups, const Criterion& criterion) {
  Readings found;
  for (const TestGroup& own : groups) {
    for (const Test* test : own.tests) {
      const double cycles = measure_of(*test, criterion.measure);
      if (!(cycles > 0)) continue;
      const auto records = last_records(*test);
      const double sides = test->result.axis.size() == 1 ? 2 : 1;
      const double first = sides == 2 ? mean_pressure(records.front().stress, test->dimension)
                                      : -records.front().stress(test->result.axis[1] - 'x', test->result.axis[1] - 'x');
      const double p = mean_pressure(records.front().stress, test->dimension);
      const double ratio = ensemble::liquefaction_of(test->protocol, test->result, test->dimension).stress_ratio;
      double error = 0, judged = 0;
      for (const records::Record& record : records)
        if (const double own_error = stress_error(*test, record); std::isfinite(own_error))
          error += own_error, judged += 1;
      found.push_back({test, ratio * p / first / sides, judged > 0 ? error / judged / first / sides : unknown, cycles});
    }
  }
  return found;
}

double resistance_at(const Readings& readings, double cycles) {
  constexpr double beyond = 1.5;
  double low = 1e300, high = 0;
  for (const Reading& each : readings) low = std::min(low, each.at), high = std::max(high, each.at);
  if (cycles < low / beyond || cycles > high * beyond) return unknown;
  return power_law(readings, cycles).intercept;
}

void add_criterion(const std::vector<TestGroup>& groups, const Criterion& criterion, Figure& figure, Sheet& sheet) {
  Readings found = resistances_of(groups, criterion);
  std::size_t tests = 0;
  for (const TestGroup& own : groups) tests += own.tests.size();
  if (found.size() < tests)
    sheet.remarks.push_back(std::to_string(tests - found.size()) + " of " + std::to_string(tests) +
                            " stress-controlled cyclic tests end before " + criterion.words + ".");
  // These fail as if loaded once, which no law of cycles describes.
  const auto at_once = std::erase_if(found, [](const Reading& each) { return each.at < 1; });
  if (at_once > 0)
    sheet.remarks.push_back(std::to_string(at_once) + " of " + std::to_string(tests) +
                            " stress-controlled cyclic tests come to " + criterion.words +
                            " within the first cycle, and are left out; choose smaller amplitudes.");
  const std::size_t before = sheet.numbers.size();
  add_by_density(sheet, criterion.exponent, found, [](const Readings& own) { return -power_law(own, 1).slope; });
  const bool has_law = sheet.numbers.size() > before;
  const std::size_t law = sheet.numbers.size();
  add_by_density(sheet, criterion.at_15, found, [](const Readings& own) { return resistance_at(own, 15); });
  add_by_density(sheet, criterion.at_20, found, [](const Readings& own) { return resistance_at(own, 20); });
  if (!has_law)
    sheet.remarks.push_back(std::string("The cyclic resistance to ") + criterion.words +
                            " is left out: no specimen comes there at two stress ratios or more, after a cycle.");
  else if (sheet.numbers.size() == law)
    sheet.remarks.push_back(std::string("CSR at 15 and 20 cycles to ") + criterion.words +
                            " is left out: no tests come near these numbers of cycles; choose other amplitudes.");
  for (const Readings& part : by_density(found)) {
    const std::string name = density_label(*part.front().test) + ", to " + criterion.words;
    Series points{name, {}, {}, {}, false, false}, line{name, {}, {}, {}, true, false};
    double low = 1e300, high = 0;
    for (const Reading& each : part) {
      points.x.push_back(each.at);
      points.y.push_back(each.value);
      low = std::min(low, each.at), high = std::max(high, each.at);
    }
    figure.series.push_back(std::move(points));
    const Straight power = power_law(part, 1);
    if (!std::isfinite(power.slope)) continue;
    for (const double cycles : {low, high}) {
      line.x.push_back(cycles);
      line.y.push_back(power.intercept * std::pow(cycles, power.slope));
    }
    figure.series.push_back(std::move(line));
  }
}

}  // namespace

void add_cyclic_resistance(const std::vector<Test>& tests, Sheet& sheet) {
  const std::vector<TestGroup> groups = groups_of(tests, Purpose::cyclic_stress);
  if (groups.empty()) {
    sheet.remarks.push_back("The cyclic resistance is left out: there is no stress-controlled cyclic test.");
    return;
  }
  std::map<std::size_t, std::string> without;  // densities
  for (const Test& test : tests) without[test.density] = test.density_name;
  for (const TestGroup& own : groups) without.erase(own.first().density);
  for (const auto& [density, name] : without)
    sheet.remarks.push_back("The cyclic resistance of " + name +
                            " is left out: there is no stress-controlled cyclic test of it.");
  Figure figure{"cyclic_resistance",
                "Cyclic resistance",
                "cycles N",
                "cyclic stress ratio CSR",
                "Single tests; lines: CSR = a N\u207b\u1d47 through those of a density.",
                true,
                false,
                {},
                cyclic_group};
  for (const Criterion& criterion : criteria) add_criterion(groups, criterion, figure, sheet);
  if (!figure.series.empty()) sheet.figures.push_back(std::move(figure));
}

}  // namespace rvelab::sheet
