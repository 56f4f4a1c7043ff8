#include "rvelab/stress_test/matrix.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "rvelab/keys/key.hpp"
#include "rvelab/stress_test/experiments.hpp"

namespace rvelab::stress_test {

namespace {

constexpr double most_seconds = 60, most_memory_MiB = 16'384;

/// One [[case]] while it is read.
class CaseReader {
 public:
  /// `limits`: [limits] of the file, for what the case does not say.
  CaseReader(const toml::table& table, const toml::table& limits, std::vector<keys::KeyError>& errors)
      : table_(table), limits_(limits), errors_(errors) {}

  std::vector<Case> cases() {
    one_.name = text("name");
    one_.experiment = text("experiment");
    one_.asked = text("asked");
    one_.invariant = text("invariant");
    one_.source = text("source");
    one_.tolerance = number("tolerance");
    one_.may_refuse = boolean("may_refuse");
    one_.may_flag = boolean("may_flag");
    one_.seconds = number("seconds");
    one_.memory_MiB = number("memory_MiB");
    expect_limits();
    expect_known_keys();
    experiment_ = find_experiment();
    if (experiment_ == nullptr) return {};
    for (const Parameter& parameter : experiment_->parameters) one_.parameters[parameter.name] = parameter.initial;
    for (const auto& [key, value] : parameters_in("with")) one_.parameters[key] = value.front();
    const auto varied = parameters_in("vary");
    quick_ = quick_values(varied);
    std::vector<Case> found;
    expand(varied, varied.begin(), one_, "", quick_everywhere_, found);
    return found;
  }

 private:
  using Values = std::map<std::string, std::vector<double>>;

  void mistake(const toml::node& node, const std::string& message) {
    errors_.push_back({long(node.source().begin.line), message});
  }
  void missing(const char* key) { mistake(table_, std::string("case.") + key + " is missing; allowed: give it"); }

  std::string text(const char* key) {
    const toml::node* node = table_.get(key);
    if (node == nullptr) return missing(key), "";
    if (!node->is_string()) mistake(*node, std::string("case.") + key + " is no text; write it in quotation marks");
    return node->value_or(std::string());
  }
  double number(const char* key) {
    const toml::node* node = table_.get(key);
    if (node == nullptr) node = limits_.get(key);
    if (node == nullptr) return missing(key), 0;
    if (!node->is_number()) mistake(*node, std::string("case.") + key + " is no number; allowed: a number > 0");
    return node->value_or(0.0);
  }
  bool boolean(const char* key) {
    const toml::node* node = table_.get(key);
    if (node != nullptr && !node->is_boolean())
      mistake(*node, std::string("case.") + key + " is neither true nor false; write one of them");
    return node != nullptr && node->value_or(false);
  }

  void expect_limits() {
    const auto expect = [&](const char* key, double value, double most) {
      const toml::node* node = table_.get(key) != nullptr ? table_.get(key) : limits_.get(key);
      if (node != nullptr && !(value > 0 && value <= most))
        mistake(*node, std::string("case.") + key + " = " + written_number(value) +
                           " is out of range; allowed: above 0 to " + written_number(most));
    };
    expect("tolerance", one_.tolerance, 1e300);
    expect("seconds", one_.seconds, most_seconds);
    expect("memory_MiB", one_.memory_MiB, most_memory_MiB);
  }

  void expect_known_keys() {
    static const std::vector<std::string> known = {"name",       "experiment", "asked",      "invariant", "source",
                                                   "tolerance",  "quick",      "may_refuse", "may_flag",  "seconds",
                                                   "memory_MiB", "with",       "vary"};
    for (const auto& [key, value] : table_)
      if (std::find(known.begin(), known.end(), std::string(key.str())) == known.end())
        errors_.push_back(keys::key_error(
            key.source(), "unknown key case." + std::string(key.str()) + "; the nearest is " +
                              keys::nearest(std::string(key.str()), known) + "; correct the name or remove it"));
  }

  const Experiment* find_experiment() {
    const toml::node* node = table_.get("experiment");
    if (node == nullptr || !node->is_string()) return nullptr;
    std::vector<std::string> names;
    for (const Experiment& experiment : experiments()) {
      if (experiment.name == one_.experiment) return &experiment;
      names.emplace_back(experiment.name);
    }
    mistake(*node, "unknown experiment \"" + one_.experiment + "\"; the nearest is \"" +
                       keys::nearest(one_.experiment, names) + "\"; correct the name");
    return nullptr;
  }

  /// Numbers of a table of parameters; one that is varied has several.
  Values parameters_in(const char* where) {
    Values found;
    const toml::node* node = table_.get(where);
    if (node == nullptr) return found;
    const toml::table* table = node->as_table();
    if (table == nullptr) {
      mistake(*node, std::string("case.") + where + " is no table; write " + where + " = {parameter = value}");
      return found;
    }
    for (const auto& [key, value] : *table) {
      const std::string name(key.str());
      if (!is_parameter(name, key.source())) continue;
      const std::vector<double> values = numbers(value);
      if (values.empty() || (value.is_array() && std::string(where) == "with"))
        mistake(value, std::string("case.") + where + "." + name + " is no " +
                           (std::string(where) == "with" ? "number" : "list of numbers") + "; allowed: numbers");
      else
        found[name] = values;
    }
    return found;
  }

  bool is_parameter(const std::string& name, const toml::source_region& place) {
    std::vector<std::string> names;
    for (const Parameter& parameter : experiment_->parameters) names.emplace_back(parameter.name);
    if (std::find(names.begin(), names.end(), name) != names.end()) return true;
    const std::string near = keys::nearest(name, names);
    errors_.push_back(keys::key_error(place, "experiment " + one_.experiment + " has no parameter " + name +
                                                 (near.empty() ? "" : "; the nearest is " + near) +
                                                 "; correct the name"));
    return false;
  }

  static std::vector<double> numbers(const toml::node& node) {
    std::vector<double> found;
    const auto take = [&](const toml::node& one) {
      if (one.is_number() || one.is_boolean())
        found.push_back(one.is_boolean() ? one.value_or(false) : one.value_or(0.));
      return one.is_number() || one.is_boolean();
    };
    if (const toml::array* list = node.as_array()) {
      for (const toml::node& one : *list)
        if (!take(one)) return {};
    } else if (!take(node)) {
      return {};
    }
    return found;
  }

  /// `quick`: true, false, or the values of varied parameters that are.
  Values quick_values(const Values& varied) {
    const toml::node* node = table_.get("quick");
    if (node != nullptr && node->is_boolean()) quick_everywhere_ = node->value_or(false);
    if (node == nullptr || node->is_boolean()) return {};
    const Values found = parameters_in("quick");
    for (const auto& [key, values] : found)
      for (const double value : values)
        if (!varied.contains(key) || !contains(varied.at(key), value))
          mistake(*node, "case.quick names " + key + " = " + written_number(value) + ", which case.vary does not");
    quick_everywhere_ = !found.empty();
    return found;
  }

  static bool contains(const std::vector<double>& values, double value) {
    return std::find(values.begin(), values.end(), value) != values.end();
  }

  void expand(const Values& varied, Values::const_iterator at, const Case& so_far, const std::string& suffix,
              bool quick, std::vector<Case>& found) const {
    if (at == varied.end()) {
      found.push_back(so_far);
      found.back().name += (suffix.empty() ? "" : "/") + suffix;
      found.back().quick = quick;
      return;
    }
    const auto& [key, values] = *at;
    for (const double value : values) {
      Case next = so_far;
      next.parameters[key] = value;
      const bool still_quick = quick && (!quick_.contains(key) || contains(quick_.at(key), value));
      expand(varied, std::next(at), next, suffix + (suffix.empty() ? "" : ",") + key + "=" + written_number(value),
             still_quick, found);
    }
  }

  const toml::table &table_, &limits_;
  std::vector<keys::KeyError>& errors_;
  const Experiment* experiment_ = nullptr;
  Case one_;
  Values quick_;
  bool quick_everywhere_ = false;
};

}  // namespace

std::string written_number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.10g", value);
  if (value != 0 && (std::abs(value) >= 1e4 || std::abs(value) < 1e-3)) std::snprintf(text, sizeof text, "%.9e", value);
  std::string written = text;
  const auto exponent = written.find('e');
  if (exponent == std::string::npos) return written;
  std::string mantissa = written.substr(0, exponent);
  if (mantissa.find('.') != std::string::npos) {
    mantissa.erase(mantissa.find_last_not_of('0') + 1);
    if (mantissa.back() == '.') mantissa.pop_back();
  }
  return mantissa + "e" + std::to_string(std::stoi(written.substr(exponent + 1)));
}

std::vector<Case> read_matrix(const std::string& path) {
  const toml::table file = keys::parse_toml_file(path);
  std::vector<keys::KeyError> errors;
  std::vector<Case> cases;
  std::set<std::string> names;
  static const toml::table no_limits;
  const toml::table* limits = file.contains("limits") ? file.get("limits")->as_table() : &no_limits;
  if (limits == nullptr) limits = &no_limits;
  for (const auto& [key, value] : *limits)
    if (key.str() != "seconds" && key.str() != "memory_MiB")
      errors.push_back(
          keys::key_error(key.source(), "unknown key limits." + std::string(key.str()) +
                                            "; allowed: seconds, memory_MiB; correct the name or remove it"));
  for (const auto& [key, value] : file) {
    if (key.str() == "limits" && value.is_table()) continue;
    const toml::array* list = value.as_array();
    if (key.str() != "case" || list == nullptr || !list->is_array_of_tables()) {
      errors.push_back(keys::key_error(
          key.source(),
          "unknown key " + std::string(key.str()) + "; allowed: [limits], [[case]]; correct the name or remove it"));
      continue;
    }
    for (const toml::node& table : *list) {
      for (Case& one : CaseReader(*table.as_table(), *limits, errors).cases()) {
        if (!names.insert(one.name).second)
          errors.push_back({long(table.source().begin.line), "case \"" + one.name + "\" is there twice; rename one"});
        cases.push_back(std::move(one));
      }
    }
  }
  if (cases.empty() && errors.empty()) errors.push_back({0, "holds no [[case]]; allowed: at least one"});
  keys::raise(path, errors);
  return cases;
}

}  // namespace rvelab::stress_test
