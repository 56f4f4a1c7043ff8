// Groups of tests that differ only by their specimen. Declared in test.hpp.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <sstream>

#include "rvelab/keys/parameters.hpp"
#include "rvelab/report/test.hpp"

namespace rvelab::report {
namespace {

constexpr double pressure_gap = 0.03, void_ratio_gap = 0.02;

/// The number of the class of each value: a class ends where the next value is more than `gap` above.
std::vector<int> classes_of(const std::vector<double>& values, double gap) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](auto one, auto other) { return values[one] < values[other]; });
  std::vector<int> found(values.size(), 0);
  for (std::size_t k = 1; k < order.size(); ++k)
    found[order[k]] = found[order[k - 1]] + (values[order[k]] - values[order[k - 1]] > gap ? 1 : 0);
  return found;
}

/// The protocol without its pressures and the name of its specimen.
std::string settings_of(const Test& test) {
  std::istringstream lines(test.recorded.provenance.protocol);
  std::string kept;
  for (std::string line; std::getline(lines, line);) {
    const std::string key = line.substr(0, line.find('='));
    const bool differs = key.find("pressure") != std::string::npos || key.starts_with("file") ||
                         key.starts_with("snapshots_every") || line.starts_with("#");
    if (!differs) kept += line + "\n";
  }
  return kept;
}

/// Parameters and the number of grains.
std::string material_of(const Test& test) {
  const Specimen& specimen = test.recorded.checkpoint.specimen;
  return std::to_string(specimen.grains.size()) + "\n" + keys::parameters_text(specimen);
}

double first_void_ratio(const Test& test) {
  const records::Record& first = calibrate::last_stage(test.recorded.result).front();
  return (first.quantities & records::asked<records::VoidRatio>) != 0 ? first.void_ratio : 0;
}

std::string in_kPa(double pressure) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g kPa", pressure / 1e3);
  return text;
}

}  // namespace

std::vector<Kind> kinds_of(const std::vector<Test>& tests) {
  const std::size_t n = tests.size();
  std::vector<double> logs;
  for (const Test& test : tests) logs.push_back(std::log(std::max(std::abs(test.pressure), 1e-300)));
  const std::vector<int> pressures = classes_of(logs, pressure_gap);
  // The void ratio falls with the pressure of a test: it distinguishes specimens only at equal pressure.
  std::vector<int> voids(n, 0);
  for (int each = 0; each <= *std::max_element(pressures.begin(), pressures.end()); ++each) {
    std::vector<std::size_t> here;
    std::vector<double> values;
    for (std::size_t k = 0; k < n; ++k)
      if (pressures[k] == each) here.push_back(k), values.push_back(first_void_ratio(tests[k]));
    const std::vector<int> own = classes_of(values, void_ratio_gap);
    for (std::size_t k = 0; k < here.size(); ++k) voids[here[k]] = own[k];
  }
  struct Key {
    std::string group, settings;
    int void_class, pressure;
    auto operator<=>(const Key&) const = default;
  };
  std::vector<Key> keys, order;
  std::set<std::string> groups, settings;
  for (std::size_t k = 0; k < n; ++k) {
    keys.push_back({tests[k].group, settings_of(tests[k]) + material_of(tests[k]), voids[k], pressures[k]});
    groups.insert(keys.back().group), settings.insert(keys.back().settings);
    if (std::find(order.begin(), order.end(), keys.back()) == order.end()) order.push_back(keys.back());
  }
  const bool several_voids = *std::max_element(voids.begin(), voids.end()) > 0;
  const bool several_pressures = *std::max_element(pressures.begin(), pressures.end()) > 0;
  std::vector<Key> sets;
  std::vector<Kind> kinds;
  for (const Key& key : order) {
    Kind kind;
    Key set = key;
    set.pressure = 0;
    const auto place = std::find(sets.begin(), sets.end(), set);
    kind.set = std::size_t(place - sets.begin());
    if (place == sets.end()) sets.push_back(set);
    double void_ratio = 0;
    for (std::size_t k = 0; k < n; ++k) {
      if (keys[k] != key) continue;
      kind.of.push_back(k);
      kind.pressure += tests[k].pressure;
      void_ratio += first_void_ratio(tests[k]);
    }
    kind.pressure /= double(kind.of.size());
    void_ratio /= double(kind.of.size());
    if (groups.size() > 1) kind.label = key.group;
    const auto add = [&](const std::string& words) { kind.label += (kind.label.empty() ? "" : ", ") + words; };
    if (several_voids && groups.size() == 1) {
      char text[32];
      std::snprintf(text, sizeof text, "e\u2080 = %.3f", void_ratio);
      add(text);
    }
    if (several_pressures || kind.label.empty()) add(in_kPa(kind.pressure));
    kinds.push_back(std::move(kind));
  }
  // Tests of different settings or materials with equal labels have the name of their first file as label.
  std::map<std::string, int> uses;
  for (const Kind& kind : kinds) ++uses[kind.label];
  for (Kind& kind : kinds)
    if (uses[kind.label] > 1) kind.label = tests[kind.of.front()].file + ", " + kind.label;
  return kinds;
}

}  // namespace rvelab::report
