#include "rvelab/protocol/table_reader.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace rvelab::protocol {
namespace {

std::string in_words(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) {
    if (!word.empty()) text += (text.empty() ? "" : ", ") + word;
  }
  return text;
}

}  // namespace

long line_of(const toml::node& node) { return static_cast<long>(node.source().begin.line); }

std::string written(const toml::node& node) {
  std::ostringstream text;
  node.visit([&](const auto& value) { text << value; });
  return text.str();
}

TableReader::TableReader(const toml::table& table, std::string where, long line, std::vector<KeyError>& errors)
    : table_(table), where_(std::move(where)), line_(line), errors_(errors) {}

const toml::node* TableReader::find(const std::string& key, bool required, const std::string& allowed) {
  know(key);
  const toml::node* node = table_.get(key);
  if (node == nullptr && required) {
    errors_.push_back({line_, where_ + "." + key + " is missing; allowed: " + allowed + "; add it"});
  }
  return node;
}

void TableReader::mistake(const std::string& key, const std::string& text) {
  const toml::node* node = table_.get(key);
  const std::string value = node == nullptr ? "" : " = " + written(*node);
  errors_.push_back({node == nullptr ? line_ : line_of(*node), where_ + "." + key + value + " " + text});
}

double TableReader::checked(const std::string& key, const toml::node& node, const io::Range& range) {
  const std::string allowed = "; allowed: " + range.in_words() + "; ";
  if (!node.is_number()) {
    mistake(key, "is not a number" + allowed + "give a number");
    return 0;
  }
  const double value = node.value<double>().value();
  if (!std::isfinite(value)) {
    mistake(key, "is not finite" + allowed + "give a finite number");
    return 0;
  }
  if (!range.contains(value)) {
    mistake(key, "is out of range" + allowed + "give a value in this range");
  }
  return value;
}

double TableReader::number(const std::string& key, std::optional<double> initial, const io::Range& range) {
  const toml::node* node = find(key, !initial, range.in_words());
  const double value = node != nullptr ? checked(key, *node, range) : initial.value_or(0);
  resolved_.insert_or_assign(key, value);
  return value;
}

long TableReader::whole_number(const std::string& key, long initial, const io::Range& range) {
  const toml::node* node = find(key, false, "");
  long value = initial;
  if (node != nullptr && !node->is_integer()) {
    mistake(key, "is not a whole number; allowed: " + range.in_words() + "; give a whole number, without a point");
  } else if (node != nullptr) {
    value = node->as_integer()->get();
    checked(key, *node, range);
  }
  resolved_.insert_or_assign(key, value);
  return value;
}

bool TableReader::truth(const std::string& key, bool initial) {
  const toml::node* node = find(key, false, "");
  bool value = initial;
  if (node != nullptr && !node->is_boolean()) {
    mistake(key, "is neither true nor false; allowed: true, false; give one of these");
  } else if (node != nullptr) {
    value = node->as_boolean()->get();
  }
  resolved_.insert_or_assign(key, value);
  return value;
}

std::string TableReader::text(const std::string& key, std::optional<std::string> initial) {
  const toml::node* node = find(key, !initial, "any text");
  std::string value = initial.value_or("");
  if (node != nullptr && (!node->is_string() || node->as_string()->get().empty())) {
    mistake(key, "is not a text; allowed: any text that is not empty; write it in quotation marks");
  } else if (node != nullptr) {
    value = node->as_string()->get();
  }
  if (!value.empty()) resolved_.insert_or_assign(key, value);
  return value;
}

std::string TableReader::word(const std::string& key, std::optional<std::string> initial,
                              const std::vector<std::string>& words) {
  const toml::node* node = find(key, !initial, in_words(words));
  std::string value = initial.value_or("");
  if (node != nullptr) {
    const bool allowed =
        node->is_string() && std::find(words.begin(), words.end(), node->as_string()->get()) != words.end();
    if (allowed) {
      value = node->as_string()->get();
    } else {
      mistake(key, "is not known; allowed: " + in_words(words) + "; choose one of these");
    }
  }
  if (!value.empty()) resolved_.insert_or_assign(key, value);
  return value;
}

std::vector<double> TableReader::numbers(const std::string& key, const io::Range& range) {
  const toml::node* node = find(key, false, "");
  std::vector<double> values;
  if (node == nullptr) return values;
  if (!node->is_array() || node->as_array()->empty()) {
    mistake(key, "is not a list of numbers; allowed: each " + range.in_words() + "; write it as [1e4, 2e4]");
    return values;
  }
  for (const auto& item : *node->as_array()) values.push_back(checked(key, item, range));
  resolved_.insert_or_assign(key, *node);
  return values;
}

void TableReader::finish() {
  for (const auto& [key, value] : table_) {
    const std::string name(key.str());
    if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
    const std::string prefix = where_.empty() ? "" : where_ + ".";
    errors_.push_back({static_cast<long>(key.source().begin.line),
                       "unknown key " + prefix + name + "; the nearest known key is " + prefix + nearest(name, known_) +
                           "; correct the name or remove it"});
  }
}

}  // namespace rvelab::protocol
