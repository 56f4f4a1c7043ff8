#include "tests/extreme/matrix.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <sstream>

#include "rvelab/error.hpp"

namespace rvelab::test {

namespace {

using Values = std::map<std::string, std::vector<double>>;

const Experiment& experiment_named(const std::string& name) {
  static const std::vector<Experiment> all = [] {
    std::vector<Experiment> list;
    for (const auto& topic :
         {stiffness_experiments(), statics_experiments(), size_experiments(), deformation_experiments(),
          increment_experiments(), rate_experiments(), impact_experiments(), gas_experiments(), number_experiments()})
      list.insert(list.end(), topic.begin(), topic.end());
    return list;
  }();
  for (const Experiment& one : all)
    if (one.name == name) return one;
  throw Error("matrix: there is no experiment " + name);
}

/// 1e4 is "1e4", 0.05 "0.05": the names of cases, by which results are kept.
std::string written(double value) {
  const bool plain = value == 0 || (std::abs(value) < 1e4 && std::abs(value) >= 1e-3);
  char text[40];
  std::snprintf(text, sizeof text, plain ? "%.10g" : "%.9e", value);
  if (plain) return text;
  const std::string all = text;
  const auto exponent = all.find('e');
  std::string mantissa = all.substr(0, exponent);
  mantissa.erase(mantissa.find_last_not_of('0') + 1);
  if (mantissa.back() == '.') mantissa.pop_back();
  return mantissa + "e" + std::to_string(std::stoi(all.substr(exponent + 1)));
}

/// Of "dimension 2, hertz 0".
std::map<std::string, double> parameters_in(const std::string& text) {
  std::map<std::string, double> found;
  std::istringstream words(text);
  double value = 0;
  for (std::string name; words >> name >> value; words.ignore()) found[name] = value;
  return found;
}

double number(const toml::node& node) {
  return node.is_boolean() ? double(*node.value<bool>()) : node.value<double>().value();
}

/// Parameters of a table {name = number} or {name = [numbers]}.
Values values_in(const toml::node* table) {
  Values found;
  if (table == nullptr || !table->is_table()) return found;
  for (const auto& [key, value] : *table->as_table()) {
    std::vector<double>& list = found[std::string(key.str())];
    if (!value.is_array()) list.push_back(number(value));
    if (value.is_array())
      for (const toml::node& one : *value.as_array()) list.push_back(number(one));
  }
  return found;
}

/// One case for each combination of the varied values.
std::vector<Case> combined(const Case& one, const Values& varied, const Values& quick) {
  std::vector<Case> found = {one};
  for (const auto& [key, values] : varied) {
    std::vector<Case> longer;
    for (const Case& before : found)
      for (const double value : values) {
        Case& more = longer.emplace_back(before);
        more.name += (key == varied.begin()->first ? "/" : ",") + key + "=" + written(value);
        more.parameters.at(key) = value;
        if (quick.contains(key)) more.quick = more.quick && std::ranges::count(quick.at(key), value) > 0;
      }
    found = std::move(longer);
  }
  return found;
}

/// A table whose keys are those of another where it has none.
toml::table with_defaults(toml::table table, const toml::table& otherwise) {
  for (const auto& [key, value] : otherwise)
    if (!table.contains(key.str())) table.insert(key.str(), value);
  return table;
}

std::vector<Case> cases_of(const toml::table& table) {
  static const std::set<std::string> known = {"name",      "experiment", "asked",    "invariant", "source",
                                              "tolerance", "may_refuse", "may_flag", "seconds",   "memory_MiB",
                                              "quick",     "with",       "vary",     "case"};
  for (const auto& [key, value] : table)
    if (!known.contains(std::string(key.str()))) throw Error("matrix: unknown key " + std::string(key.str()));
  const auto text = [&](const char* key) { return table[key].value<std::string>().value(); };
  Case one;
  one.name = text("name");
  one.experiment = &experiment_named(text("experiment"));
  one.asked = text("asked");
  if (text("invariant").empty() || text("source").empty()) throw Error("matrix: " + one.name + " has no judge");
  one.tolerance = table["tolerance"].value<double>().value();
  const Values quick = values_in(table.get("quick")), varied = values_in(table.get("vary"));
  one.quick = table["quick"].value_or(!quick.empty());
  one.may_refuse = table["may_refuse"].value_or(false);
  one.may_flag = table["may_flag"].value_or(false);
  one.seconds = table["seconds"].value<double>().value();
  one.memory_MiB = table["memory_MiB"].value<double>().value();
  one.parameters = parameters_in(one.experiment->parameters);
  for (const auto& [key, values] : values_in(table.get("with"))) one.parameters.at(key) = values.at(0);
  for (const auto& [key, values] : quick)
    for (const double value : values)
      if (std::ranges::count(varied.at(key), value) == 0) throw Error("matrix: " + one.name + ": quick is not varied");
  return combined(one, varied, quick);
}

}  // namespace

std::vector<Case> read_matrix(const std::string& path) {
  const toml::table file = toml::parse_file(path);
  std::vector<Case> cases;
  for (const toml::node& series : *file["series"].as_array()) {
    const toml::table shared = with_defaults(*series.as_table(), *file["limits"].as_table());
    for (const toml::node& one : *shared["case"].as_array())
      for (Case& found : cases_of(with_defaults(*one.as_table(), shared))) cases.push_back(std::move(found));
  }
  return cases;
}

}  // namespace rvelab::test
