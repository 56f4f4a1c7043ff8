#include "rvelab/report/tables.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <span>

#include "rvelab/calibrate/calibrate.hpp"
#include "rvelab/ensemble/loops.hpp"
#include "rvelab/keys/parameters.hpp"
#include "rvelab/protocol/stage_kinds.hpp"
#include "rvelab/report/words.hpp"

namespace rvelab::report {
namespace {

using ensemble::nan;

const std::set<std::string> shown_keys{"axis",
                                       "plane",
                                       "lateral",
                                       "normal",
                                       "to_strain",
                                       "cycles",
                                       "drive",
                                       "pressure_Pa",
                                       "record_every",
                                       "lateral_pressure_Pa",
                                       "normal_pressure_Pa",
                                       "size",
                                       "directions",
                                       "reverse_at_Pa"};

std::string plain(const toml::node& node) {
  if (const auto number = node.value<double>(); number && !node.is_boolean()) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", *number);
    return text;
  }
  if (const auto text = node.value<std::string>()) return *text;
  if (const auto truth = node.value<bool>()) return *truth ? "yes" : "no";
  std::string list;
  if (const auto* array = node.as_array())
    for (const auto& each : *array) list += (list.empty() ? "" : ", ") + plain(each);
  return list;
}

/// Diameters for given shares of the mass passing, m.
std::vector<double> grading_of(const Specimen& specimen, int dimension, const std::vector<double>& parts) {
  std::vector<double> radii = specimen.grains.radius;
  std::sort(radii.begin(), radii.end());
  std::vector<double> passing;
  double sum = 0;
  for (const double radius : radii) passing.push_back(sum += std::pow(radius, dimension));
  std::vector<double> found;
  for (const double part : parts) {
    const auto place = std::lower_bound(passing.begin(), passing.end(), part * sum);
    found.push_back(2 * radii[std::min(radii.size() - 1, std::size_t(place - passing.begin()))]);
  }
  return found;
}

std::string list_of(const std::vector<double>& values, double factor) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + in_three_digits(factor * value);
  return text;
}

/// "friction angle (degrees)" for friction_angle_deg.
std::string in_words(std::string name, const std::string& unit) {
  for (const char* end : {"_deg", "_Pa"})
    if (name.ends_with(end)) name.erase(name.size() - std::string(end).size());
  if (name == "secant_friction_angle") name = "friction_angle_of_all_pressures";
  std::replace(name.begin(), name.end(), '_', ' ');
  return name + (unit.empty() ? "" : " (" + unit + ")");
}

std::vector<ensemble::TestOf> as_ensemble(const std::vector<Test>& tests, const std::vector<Kind>& kinds) {
  std::vector<ensemble::TestOf> found;
  std::map<std::uint64_t, std::size_t> specimens;
  for (const Kind& kind : kinds)
    for (const std::size_t k : kind.of) {
      const Test& test = tests[k];
      // Without a checksum of the specimen each test counts as a separate specimen.
      const std::uint64_t sum = test.recorded.provenance.specimen_crc32c;
      const std::size_t specimen =
          specimens.emplace(sum != 0 ? sum : std::uint64_t(-1) - k, specimens.size()).first->second;
      found.push_back({kind.set, specimen, kind.pressure, test.measured, test.strength,
                       calibrate::grains_stick(test.recorded.checkpoint.specimen)});
    }
  return found;
}

}  // namespace

Table asked_of(const std::vector<Test>& tests, const std::vector<Kind>& kinds) {
  std::set<std::uint64_t> specimens;
  std::set<double> pressures;
  for (const Test& test : tests) specimens.insert(test.recorded.provenance.specimen_crc32c);
  for (const Kind& kind : kinds) pressures.insert(kind.pressure);
  Table rows{{"", ""}, {"tests", counted(tests.size(), "test") + " on " + counted(specimens.size(), "specimen")}};
  std::string text;
  for (const double pressure : pressures) text += (text.empty() ? "" : ", ") + in_three_digits(pressure / 1e3);
  rows.push_back({"pressure", text + " kPa"});
  const toml::table whole = toml::parse(tests.front().recorded.provenance.protocol);
  if (const auto* stages = whole["stage"].as_array()) {
    for (const auto& each : *stages) {
      const auto* stage = each.as_table();
      if (stage == nullptr) continue;
      const std::string kind = (*stage)["kind"].value_or<std::string>(""), own = (*stage)["name"].value_or(kind);
      std::string keys;
      for (const auto& [key, value] : *stage) {
        const std::string name(key.str());
        const bool of_all = pressures.size() == 1 || name.find("pressure") == std::string::npos;
        if (shown_keys.contains(name) && of_all) keys += (keys.empty() ? "" : "; ") + name + " " + plain(value);
      }
      rows.push_back({"stage " + own, kind + (keys.empty() ? "" : ": " + keys)});
    }
  }
  for (const char* table : {"loading", "contact", "damping", "solver"})
    if (const auto* found = whole[table].as_table()) {
      std::string keys;
      for (const auto& [key, value] : *found)
        keys += (keys.empty() ? "" : "; ") + std::string(key.str()) + " " + plain(value);
      if (!keys.empty()) rows.push_back({table, keys});
    }
  return rows;
}

Table specimen_of(const Test& test) {
  const Specimen& specimen = test.recorded.checkpoint.specimen;
  const int d = test.dimension;
  const std::vector<double> grading = grading_of(specimen, d, {0.1, 0.5, 0.6});
  const auto& radius = specimen.grains.radius;
  const double diameter = 2 * std::accumulate(radius.begin(), radius.end(), 0.0) / double(radius.size());
  const bool small = grading[1] < 1e-3;
  Table rows{{"", ""},
             {"grains", counted(specimen.grains.size(), name(specimen.shape)) + ", " + std::to_string(d) + "D"},
             {"d10, d50, d60", list_of(grading, small ? 1e6 : 1e3) + (small ? " \u00b5m" : " mm") +
                                   "; uniformity d60/d10 " + in_three_digits(grading[2] / grading[0])}};
  std::string lengths;
  for (int k = 0; k < d; ++k)
    lengths += (k > 0 ? " \u00d7 " : "") + in_three_digits(specimen.cell.lattice.col(k).norm() / diameter);
  rows.push_back({"cell at the end", lengths + " mean diameters"});
  const records::Record& first = test.records().front();
  if ((first.quantities & records::asked<records::VoidRatio>) != 0) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3f", first.void_ratio);
    rows.push_back({"void ratio at the start", text});
  }
  if ((first.quantities & records::asked<records::CoordinationNumber>) != 0)
    rows.push_back({"coordination number at the start", in_three_digits(first.coordination_number)});
  const toml::table parameters = toml::parse(keys::parameters_text(specimen));
  for (const auto& [key, node] : parameters) {
    const auto add = [&rows](const std::string& label, const toml::table& table) {
      std::string values;
      for (const auto& [own, value] : table)
        if (own.str() != "name") values += (values.empty() ? "" : "; ") + std::string(own.str()) + " " + plain(value);
      rows.push_back({label, values});
    };
    if (key.str() == "solver") continue;
    if (const auto* table = node.as_table()) {
      const bool of_tables =
          std::all_of(table->begin(), table->end(), [](auto&& each) { return each.second.is_table(); });
      if (!of_tables) add(std::string(key.str()), *table);
      if (of_tables)
        for (const auto& [own, inner] : *table)
          add(std::string(key.str()) + " " + std::string(own.str()), *inner.as_table());
    } else if (const auto* list = node.as_array()) {
      for (const auto& each : *list)
        if (const auto* table = each.as_table())
          add(std::string(key.str()) + " " + (*table)["name"].value_or(std::string()), *table);
    }
  }
  return rows;
}

std::vector<std::string> names_of_sets(const std::vector<Kind>& kinds) {
  std::vector<std::string> names;
  for (const Kind& kind : kinds) {
    std::string label = kind.label;
    // Without the pressure, which distinguishes kinds of one set.
    if (const auto at = label.rfind(", "); label.ends_with(" kPa") && at != std::string::npos) label.erase(at);
    if (kind.set == names.size()) names.push_back(label);
  }
  if (names.size() == 1) names[0].clear();
  return names;
}

Results results_of(const std::vector<Test>& tests, const std::vector<Kind>& kinds) {
  Results results;
  results.summary = ensemble::summary_of(as_ensemble(tests, kinds));
  const std::vector<std::string> names = names_of_sets(kinds);
  const bool several_sets = names.size() > 1;
  const auto at = [](double pressure) {
    return std::isnan(pressure) ? std::string("all") : in_three_digits(pressure / 1e3) + " kPa";
  };
  const auto row = [&](const std::string& measure, const std::string& unit, double value, double error, double low,
                       double high, std::vector<std::string> before) {
    const InUnit shown = fitting_unit(value, unit);
    before.push_back(in_words(measure, shown.unit));
    before.push_back(with_its_error(shown.factor * value, shown.factor * error));
    before.push_back(interval_in_words(shown.factor * low, shown.factor * high));
    return before;
  };
  results.means = {{"pressure", "n", "measure", "mean \u00b1 standard error", "95 % interval of the mean"}};
  if (several_sets) results.means[0].insert(results.means[0].begin(), "group");
  for (const ensemble::Row& each : results.summary.rows) {
    std::vector<std::string> before{at(each.pressure), std::to_string(each.spread.n)};
    if (several_sets) before.insert(before.begin(), names[each.group]);
    results.means.push_back(row(each.name, each.unit, each.spread.mean, each.spread.standard_error, each.spread.low,
                                each.spread.high, std::move(before)));
  }
  results.differences = {{"pressure", "measure", "difference \u00b1 standard error", "95 % interval"}};
  for (const ensemble::Comparison& each : results.summary.comparisons)
    results.differences.push_back(row(each.name, each.unit, each.difference.value, each.difference.standard_error,
                                      each.difference.low, each.difference.high, {at(each.pressure)}));
  return results;
}

Table loops_of(const std::vector<Test>& tests) {
  Table rows{{"test", "stage", "loop", "amplitude of the shear strain (%)", "secant shear modulus (MPa)",
              "damping ratio (%)", "G/G_max", "G_max (MPa)", "G_max is of"}};
  for (const Test& test : tests) {
    const auto& records = test.records();
    for (std::size_t begin = 0, end = 0; begin < records.size(); begin = end) {
      while (end < records.size() && records[end].stage == records[begin].stage) ++end;
      const protocol::Stage& stage = test.protocol.stages.at(std::size_t(records[begin].stage));
      const auto* shear = protocol::settings_of<protocol::SimpleShearStage>(stage);
      const auto* compression = protocol::settings_of<protocol::CompressionStage>(stage);
      if (!(shear != nullptr && shear->cycles.count > 0) && !(compression != nullptr && compression->cycles.count > 0))
        continue;
      const std::span<const records::Record> whole{records.data() + begin, end - begin};
      const std::string& axis = test.recorded.result.axis;
      const auto loops = ensemble::loops_of(whole, axis, test.dimension);
      const ensemble::ReferenceModulus G_max =
          ensemble::reference_modulus(whole, loops, test.recorded.result.probes, axis, test.dimension);
      for (std::size_t k = 0; k < loops.size(); ++k)
        rows.push_back({test.file, stage.name, std::to_string(k + 1), in_three_digits(100 * loops[k].gamma),
                        in_three_digits(loops[k].G / 1e6), in_three_digits(100 * loops[k].damping_ratio),
                        in_three_digits(loops[k].G / G_max.G), in_three_digits(G_max.G / 1e6), G_max.of});
    }
  }
  return rows;
}

}  // namespace rvelab::report
