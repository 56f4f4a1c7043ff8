#include "rvelab/keys/table_reader.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "rvelab/error.hpp"
#include "rvelab/keys/key_units.hpp"
#include "rvelab/keys/shortened.hpp"

namespace rvelab::keys {
namespace {

void refuse_unknown(const toml::source_region& place, const std::string& prefix, const std::string& name,
                    const std::vector<std::string>& known, std::vector<KeyError>& errors) {
  errors.push_back(key_error(place, "unknown key " + prefix + shortened(name) + "; the nearest known key is " + prefix +
                                        nearest(name, known) + "; correct the name or remove it"));
}

}  // namespace

long line_of(const toml::node& node) { return static_cast<long>(node.source().begin.line); }

std::string written(const toml::node& node) {
  if (node.is_floating_point()) {  // the library writes 17 digits
    char shortest[32];
    const auto end = std::to_chars(std::begin(shortest), std::end(shortest), node.as_floating_point()->get()).ptr;
    return {shortest, end};
  }
  std::ostringstream text;
  node.visit([&](const auto& value) { text << value; });
  return shortened(text.str());
}

std::string wrong_with(const toml::node& value, const Key& key, const Interval& range,
                       const std::vector<std::string>& choices) {
  const std::string allowed = "; allowed: " + key.allowed() + "; ";
  if (key.type == "boolean")
    return value.is_boolean() ? "" : "is neither true nor false" + allowed + "give true or false";
  if (key.type == "text") {
    const bool good = value.is_string() && !value.as_string()->get().empty();
    return good ? "" : "is not a text; allowed: any text that is not empty; write it in quotation marks";
  }
  if (key.type == "choice") {
    const std::string word = value.is_string() ? value.as_string()->get() : written(value);
    const bool good = value.is_string() && std::find(choices.begin(), choices.end(), word) != choices.end();
    return good ? "" : (value.is_string() ? "is not known" : "is not a word") + allowed + choose_one(word, choices);
  }
  const bool whole = key.type == "whole number";
  if (whole && !value.is_integer()) return "is not a whole number" + allowed + "give a whole number, without a point";
  if (!value.is_number()) return "is not a number" + allowed + "give a number";
  if (!std::isfinite(number_in(value))) return "is not finite" + allowed + "give a finite number";
  if (range.contains(number_in(value))) return "";
  const double hundredth = number_in(value) / 100;
  const bool per_cent =
      key.unit == "1" && !whole && number_in(value) >= 1 && range.high <= 1 && range.contains(hundredth);
  return "is out of range" + allowed +
         (per_cent ? "if per cent was meant, write " + in_words(hundredth) : "give a value in this range");
}

void expect_top_tables(const toml::table& file, std::vector<KeyError>& errors, const std::vector<std::string>& known) {
  for (const auto& [key, value] : file) {
    const std::string name(key.str());
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      refuse_unknown(place_of(key, value), "", name, known, errors);
    }
  }
}

const toml::table& table_of(const toml::table& file, const std::string& name, std::vector<KeyError>& errors) {
  static const toml::table nothing;
  const toml::node* node = file.get(name);
  if (node == nullptr) return nothing;
  if (node->is_table()) return *node->as_table();
  errors.push_back(
      key_error(node->source(), name + " is not a table; allowed: [" + name + "] with its keys below; write it so"));
  return nothing;
}

TableReader::TableReader(const toml::table& table, const std::vector<TableKey>& all, const std::string& key_table,
                         std::string where, long line, std::vector<KeyError>& errors)
    : table_(table), all_(all), where_(std::move(where)), line_(line), errors_(errors) {
  also(key_table);
}

void TableReader::also(const std::string& key_table) {
  key_tables_.push_back(key_table);
  for (const TableKey& entry : all_) {
    if (entry.key.table == key_table) known_.push_back(entry.key);
  }
}

const TableKey& TableReader::entry(const std::string& name) {
  asked_.push_back(name);
  for (const TableKey& entry : all_) {
    const bool here = std::find(key_tables_.begin(), key_tables_.end(), entry.key.table) != key_tables_.end();
    if (here && entry.key.name == name) return entry;
  }
  throw std::logic_error("no entry for the key " + key_tables_.back() + "." + name + " in its table of keys");
}

bool TableReader::has_in_another_unit(const std::string& name) const {
  return std::any_of(table_.begin(), table_.end(), [&](const auto& item) {
    const auto answer = in_another_unit(std::string(item.first.str()), known_);
    return answer && answer->key.name == name;
  });
}

const toml::node* TableReader::find(const TableKey& key, bool required) {
  const toml::node* node = table_.get(key.key.name);
  if (node == nullptr && required && !has_in_another_unit(key.key.name)) {
    errors_.push_back({line_, where_ + "." + key.key.name + " is missing; allowed: " + key.key.allowed() + "; add it"});
  }
  return node;
}

void TableReader::mistake(const std::string& name, const std::string& text) {
  const toml::node* node = table_.get(name);
  if (node == nullptr) {
    errors_.push_back({line_, where_ + "." + name + " " + text});
  } else {
    errors_.push_back(key_error(node->source(), where_ + "." + name + " = " + written(*node) + " " + text));
  }
}

std::optional<double> TableReader::checked(const TableKey& key, const toml::node& node) {
  Key number = key.key;
  number.type = "number";  // of a list each
  const std::string wrong = wrong_with(node, number, key.range, {});
  if (wrong.empty()) return number_in(node);
  mistake(key.key.name, wrong);
  return std::nullopt;
}

const toml::node* TableReader::good(const TableKey& key, bool required) {
  const toml::node* node = find(key, required);
  const std::string wrong = node == nullptr ? "" : wrong_with(*node, key.key, key.range, key.choices);
  if (!wrong.empty()) mistake(key.key.name, wrong);
  return wrong.empty() ? node : nullptr;
}

double TableReader::number(const std::string& name, std::optional<double> instead) {
  const TableKey& key = entry(name);
  if (!instead && std::holds_alternative<double>(key.initial)) instead = std::get<double>(key.initial);
  const toml::node* node = good(key, !instead);
  const double value = node != nullptr ? number_in(*node) : instead.value_or(0);
  resolved_.insert_or_assign(name, value);
  return value;
}

std::optional<double> TableReader::optional_number(const std::string& name) {
  if (!has(name)) {
    leave(name);
    return std::nullopt;
  }
  return number(name);
}

long TableReader::whole_number(const std::string& name) {
  const TableKey& key = entry(name);
  const auto* initial = std::get_if<long>(&key.initial);
  const toml::node* node = good(key, initial == nullptr);
  const long value = node != nullptr ? node->as_integer()->get() : initial == nullptr ? 0 : *initial;
  resolved_.insert_or_assign(name, value);
  return value;
}

std::optional<long> TableReader::optional_whole_number(const std::string& name) {
  if (!has(name)) {
    leave(name);
    return std::nullopt;
  }
  return whole_number(name);
}

bool TableReader::boolean(const std::string& name, std::optional<bool> instead) {
  const TableKey& key = entry(name);
  if (!instead && std::holds_alternative<bool>(key.initial)) instead = std::get<bool>(key.initial);
  const toml::node* node = good(key, !instead);
  const bool value = node != nullptr ? node->as_boolean()->get() : instead.value_or(false);
  resolved_.insert_or_assign(name, value);
  return value;
}

std::string TableReader::text(const std::string& name, std::optional<std::string> instead) {
  const TableKey& key = entry(name);
  if (!instead && std::holds_alternative<std::string>(key.initial)) instead = std::get<std::string>(key.initial);
  const toml::node* node = good(key, !instead);
  const std::string value = node != nullptr ? node->as_string()->get() : instead.value_or("");
  if (!value.empty()) resolved_.insert_or_assign(name, value);
  return value;
}

std::string TableReader::choice(const std::string& name, std::optional<std::string> instead) {
  return text(name, std::move(instead));
}

void TableReader::finish() {
  std::vector<std::string> names;
  for (const Key& key : known_) {
    names.push_back(key.name);
    if (std::find(asked_.begin(), asked_.end(), key.name) != asked_.end()) continue;
    throw std::logic_error("the key " + key.dotted() + " has an entry and is not read");
  }
  const std::string prefix = where_ + ".";
  for (const auto& [key, value] : table_) {
    const std::string name(key.str());
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    if (const auto answer = in_another_unit(name, known_)) {
      errors_.push_back(key_error(place_of(key, value), prefix + shortened(name) + " is not known; write " + prefix +
                                                            answer->key.name + ", " + answer->factor));
    } else {
      refuse_unknown(place_of(key, value), prefix, name, names, errors_);
    }
  }
}

}  // namespace rvelab::keys
