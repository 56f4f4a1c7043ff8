#include "rvelab/keys/table_reader.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>

#include "rvelab/contact/interval_words.hpp"
#include "rvelab/error.hpp"
#include "rvelab/keys/shortened.hpp"

namespace rvelab::keys {
namespace {

void refuse_unknown(const toml::source_region& place, const std::string& prefix, const std::string& name,
                    const std::vector<std::string>& known, std::vector<KeyError>& errors) {
  errors.push_back(
      key_error(place, "unknown key " + prefix + shortened(name) + "; " + what_was_meant(prefix, name, known)));
}

bool holds(const Choices& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

}  // namespace

std::string as_toml(double value) {
  TextStream text;
  text.precision(15);
  text << value;
  return text.str();
}

std::string as_toml(const std::string& value) { return "\"" + value + "\""; }

std::string listed(const Choices& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

long line_of(const toml::node& node) { return long(node.source().begin.line); }

std::string written(const toml::node& node) {
  if (node.is_floating_point()) {  // the library writes 17 digits
    char shortest[32];
    const auto end = std::to_chars(std::begin(shortest), std::end(shortest), node.as_floating_point()->get()).ptr;
    return {shortest, end};
  }
  TextStream text;
  node.visit([&](const auto& value) { text << value; });
  return shortened(text.str());
}

std::string written_file(const toml::table& file) {
  TextStream text;
  text << toml::toml_formatter{file} << "\n";
  return text.str();
}

std::string wrong_with(const toml::node& value, const Key& key) {
  const std::string allowed = "; allowed: " + key.allowed() + "; ";
  if (key.type == "boolean")
    return value.is_boolean() ? "" : "is neither true nor false" + allowed + "give true or false";
  if (key.type == "text") {
    const bool good = value.is_string() && !value.as_string()->get().empty();
    return good ? "" : "is not a text; allowed: any text that is not empty; write it in quotation marks";
  }
  if (key.type == "choice") {
    const std::string word = value.is_string() ? value.as_string()->get() : written(value);
    if (value.is_string() && holds(key.choices, word)) return "";
    return (value.is_string() ? "is not known" : "is not a word") + allowed + choose_one(word, key.choices);
  }
  const bool whole = key.type == "whole number";
  if (whole && !value.is_integer()) return "is not a whole number" + allowed + "give a whole number, without a point";
  if (!value.is_number()) return "is not a number" + allowed + "give a number";
  if (!std::isfinite(number_in(value))) return "is not finite" + allowed + "give a finite number";
  if (key.interval.contains(number_in(value))) return "";
  const double hundredth = number_in(value) / 100;
  constexpr double of_shares = 10;  // a range that ends below it is one of shares and ratios
  const bool per_cent = key.unit == "1" && !whole && number_in(value) >= 1 && key.interval.high <= of_shares &&
                        key.interval.contains(hundredth);
  return "is out of range" + allowed +
         (per_cent ? "if per cent was meant, write " + in_words(hundredth) : "give a value in this range");
}

void expect_top_tables(const toml::table& file, std::vector<KeyError>& errors, const std::vector<std::string>& known) {
  for (const auto& [key, value] : file) {
    const std::string name(key.str());
    if (!holds(known, name)) refuse_unknown(place_of(key, value), "", name, known, errors);
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

Key TableReader::asked(Asked a) {
  Key key{key_table_, a.name,     a.unit,    a.type,     a.initial,       a.range,
          a.meaning,  a.interval, a.choices, a.required, a.interval.usual};
  known_.push_back(key);
  return key;
}

bool TableReader::has_in_another_unit(const std::string& name) const {
  return std::any_of(table_.begin(), table_.end(), [&](const auto& item) {
    const auto answer = in_another_unit(std::string(item.first.str()), known_);
    return answer && answer->key.name == name;
  });
}

const toml::node* TableReader::find(const Key& key) {
  const toml::node* node = table_.get(key.name);
  if (node == nullptr && key.required) expect(key.name, "is missing; allowed: " + key.allowed() + "; add it");
  return node;
}

void TableReader::mistake(const std::string& name, const std::string& text) {
  const toml::node* node = table_.get(name);
  const KeyError error = node == nullptr
                             ? KeyError{line_, dotted(name) + " " + text}
                             : key_error(node->source(), dotted(name) + " = " + written(*node) + " " + text);
  const bool told = !errors_.empty() && errors_.back().line == error.line && errors_.back().message == error.message;
  if (!told) errors_.push_back(error);  // of several entries of a list once
}

void TableReader::doubt(const std::string& name, const std::string& text) {
  const toml::node* node = table_.get(name);
  if (text.empty() || node == nullptr) return;
  errors_.push_back(key_error(node->source(), dotted(name) + " = " + written(*node) + " " + text));
  errors_.back().doubt = true;
}

void TableReader::refuse(const std::string& name, const std::string& text) {
  if (has(name)) mistake(name, text);
  resolved_.erase(name);
}

void TableReader::expect(const std::string& name, const std::string& text) {
  if (has(name) || has_in_another_unit(name)) return;
  const auto key = std::find_if(known_.begin(), known_.end(), [&](const Key& each) { return each.name == name; });
  mistake(name, text.empty() ? "is missing; allowed: " + key->allowed() + "; add it" : text);
}

void TableReader::mistake_in(const std::string& list, const std::string& text) {
  errors_.push_back({line_of(*table_.get(list)->as_array()->get(0)), where_ + ": " + text});
}

std::optional<double> TableReader::checked(const Key& key, const toml::node& node) {
  Key number = key;
  number.type = "number";  // of a list each
  const std::string wrong = wrong_with(node, number);
  if (wrong.empty()) {
    doubt(key.name, unusual_in(key, number_in(node)));
    return number_in(node);
  }
  mistake(key.name, wrong);
  return std::nullopt;
}

const toml::node* TableReader::good(const Key& key) {
  const toml::node* node = find(key);
  const std::string wrong = node == nullptr ? "" : wrong_with(*node, key);
  if (!wrong.empty()) mistake(key.name, wrong);
  return wrong.empty() ? node : nullptr;
}

std::optional<double> TableReader::number_given(Asked key) {
  key.type = "number";
  if (key.range.empty()) key.range = in_words(key.interval);
  const toml::node* node = good(asked(key));
  if (node == nullptr) return std::nullopt;
  const double value = number_in(*node);
  doubt(key.name, unusual_in(known_.back(), value));
  resolved_.insert_or_assign(key.name, value);
  return value;
}

std::optional<long> TableReader::whole_given(Asked key) {
  key.unit = "1";
  key.type = "whole number";
  if (key.range.empty()) key.range = in_words(key.interval);
  const toml::node* node = good(asked(key));
  return node == nullptr ? std::nullopt : std::optional<long>(node->as_integer()->get());
}

std::optional<std::string> TableReader::word_given(Asked key) {
  key.unit = "-";
  key.type = key.choices.empty() ? "text" : "choice";
  key.range = key.choices.empty() ? "any text" : listed(key.choices);
  const toml::node* node = good(asked(key));
  if (node == nullptr) return std::nullopt;
  resolved_.insert_or_assign(key.name, *node);
  return node->as_string()->get();
}

void TableReader::number(const char* name, double& value, const char* unit, const Range& range, const char* meaning) {
  value = optional_number(name, unit, range, meaning, as_toml(value)).value_or(value);
  resolve(name, value);
}

bool TableReader::required_number(const char* name, double& value, const char* unit, const Range& range,
                                  const char* meaning, const char* allowed) {
  const auto given = number_given({name, unit, "", "", allowed, meaning, range, {}, true});
  value = given.value_or(value);
  return given.has_value();
}

std::optional<double> TableReader::optional_number(const char* name, const char* unit, const Range& range,
                                                   const char* meaning, const std::string& initial,
                                                   const char* allowed) {
  return number_given({name, unit, "", initial, allowed, meaning, range});
}

std::optional<long> TableReader::optional_whole_number(const char* name, const Interval& range, const char* meaning,
                                                       const char* initial, const char* allowed) {
  const auto given = whole_given({name, "", "", initial, allowed, meaning, range});
  if (given) resolved_.insert_or_assign(name, std::int64_t{*given});
  return given;
}

void TableReader::boolean(const char* name, bool& value, const char* meaning, const char* initial) {
  const char* const usual = initial != nullptr ? initial : value ? "true" : "false";
  if (const toml::node* node = good(asked({name, "-", "boolean", usual, "true, false", meaning})))
    value = node->as_boolean()->get();
  resolved_.insert_or_assign(name, value);
}

void TableReader::text(const char* name, std::string& value, const char* meaning, const char* initial) {
  const std::string usual = initial != nullptr ? initial : value.empty() ? "" : as_toml(value);
  value = word_given({name, "", "", usual, "", meaning}).value_or(value);
  if (!value.empty()) resolved_.insert_or_assign(name, value);
}

std::string TableReader::required_text(const char* name, const char* meaning) {
  return word_given({name, "", "", "", "", meaning, {}, {}, true}).value_or("");
}

std::size_t TableReader::number_of_choice(const char* name, std::size_t value, const Choices& words,
                                          const std::string& meaning) {
  const auto word = word_given({name, "", "", as_toml(words[value]), "", meaning, {}, words}).value_or(words[value]);
  resolved_.insert_or_assign(name, word);
  return std::size_t(std::find(words.begin(), words.end(), word) - words.begin());
}

std::string TableReader::choice(const char* name, const std::string& instead, const Choices& words, const char* meaning,
                                const char* initial) {
  const std::string word = word_given({name, "", "", initial, "", meaning, {}, words}).value_or(instead);
  if (!word.empty()) resolved_.insert_or_assign(name, word);
  return word;
}

std::string TableReader::required_choice(const char* name, const Choices& words, const char* meaning) {
  return word_given({name, "", "", "", "", meaning, {}, words, true}).value_or("");
}

std::vector<double> TableReader::numbers(const char* name, const char* unit, const Range& each, const char* meaning,
                                         const char* allowed, bool required) {
  const std::string words = allowed != nullptr ? allowed : "each " + in_words(each);
  const Key key = asked({name, unit, "list of numbers", "", words, meaning, each, {}, required});
  const toml::node* node = find(key);
  std::vector<double> values;
  if (node == nullptr) return values;
  if (!node->is_array() || node->as_array()->empty()) {
    mistake(name, "is not a list of numbers; allowed: " + key.allowed() + "; write it as [1e4, 2e4]");
    return values;
  }
  for (const auto& item : *node->as_array()) values.push_back(checked(key, item).value_or(0));
  resolved_.insert_or_assign(name, *node);
  return values;
}

std::vector<std::string> TableReader::choices(const char* name, const Choices& words, const char* meaning,
                                              const std::string& initial) {
  const Key key = asked({name, "-", "list of choices", initial, listed(words), meaning, {}, words});
  const toml::node* node = find(key);
  std::vector<std::string> values;
  if (node == nullptr) return values;
  const auto refused = [&](const std::string& why) {
    mistake(name, "is not a list of known choices; allowed: " + key.allowed() + "; " + why + "write it as [\"" +
                      words.front() + "\"]");
    return std::vector<std::string>();
  };
  if (!node->is_array()) return refused("");
  for (const auto& item : *node->as_array()) {
    values.push_back(item.is_string() ? item.as_string()->get() : written(item));
    if (item.is_string() && holds(words, values.back())) continue;
    return refused(values.back() + " is none of them, the nearest is " + nearest(values.back(), words) + "; ");
  }
  resolved_.insert_or_assign(name, *node);
  return values;
}

std::vector<std::string> TableReader::texts(const char* name, const char* meaning) {
  const toml::node* node = find(asked({name, "-", "list of texts", "", "any texts", meaning}));
  std::vector<std::string> found;
  if (node == nullptr) return found;
  bool good = node->is_array();
  for (std::size_t k = 0; good && k < node->as_array()->size(); ++k) {
    const toml::node& item = *node->as_array()->get(k);
    good = item.is_string();
    if (good) found.push_back(item.as_string()->get());
  }
  if (!good) mistake(name, "is no list of texts; allowed: [\"...\", ...]; correct it");
  return found;
}

Matrix3 TableReader::components(const char* name, const char* unit, const char* meaning, bool symmetric) {
  const char* const allowed = symmetric ? symmetric_components : "xx, xy, xz, yx, yy, yz, zx, zy, zz = numbers";
  const Key key = asked({name, unit, "components", "", allowed, meaning, every, {}, !symmetric});
  const toml::node* node = find(key);
  Matrix3 tensor = Matrix3::Zero();
  if (node == nullptr) return tensor;
  if (!node->is_table() || node->as_table()->empty()) {
    mistake(name, "is not a table of components; allowed: " + key.allowed() + "; write it as {xx = 1, xy = 0.5}");
    return tensor;
  }
  for (const auto& [component, value] : *node->as_table()) {
    const std::string axes(component.str());
    const bool known = axes.size() == 2 && axes.find_first_not_of("xyz") == std::string::npos;
    if (!known || (symmetric && axes[0] > axes[1])) {
      mistake(name, "names no component \"" + axes + "\"; allowed: " + key.allowed() + "; correct it");
      continue;
    }
    const double number = checked(key, value).value_or(0);
    const int i = axes[0] - 'x', j = axes[1] - 'x';
    tensor(i, j) = number;
    if (symmetric) tensor(j, i) = number;
  }
  resolved_.insert_or_assign(name, *node);
  return tensor;
}

std::vector<Matrix3> TableReader::matrices(const char* name, const char* meaning) {
  const Key key = asked(
      {name, "1", "list of lists of numbers", "", "4 (2D) or 9 numbers each, row by row", meaning, every, {}, true});
  const toml::node* node = find(key);
  std::vector<Matrix3> list;
  if (node == nullptr) return list;
  const auto good = [](const toml::node& item) {
    return item.is_array() && (item.as_array()->size() == 4 || item.as_array()->size() == 9) &&
           std::all_of(item.as_array()->begin(), item.as_array()->end(),
                       [](const toml::node& each) { return each.is_number() && std::isfinite(number_in(each)); });
  };
  if (!node->is_array() || node->as_array()->empty() ||
      !std::all_of(node->as_array()->begin(), node->as_array()->end(), good)) {
    mistake(name, "is not a list of matrices; allowed: " + key.allowed() + "; write it as [[1, 0, 0, 0.99]]");
    return list;
  }
  for (const auto& item : *node->as_array()) {
    const toml::array& numbers = *item.as_array();
    const int size = numbers.size() == 4 ? 2 : 3;
    Matrix3 matrix = Matrix3::Identity();
    for (int k = 0; k < size * size; ++k) matrix(k / size, k % size) = number_in(*numbers.get(std::size_t(k)));
    list.push_back(matrix);
  }
  resolved_.insert_or_assign(name, *node);
  return list;
}

std::vector<const toml::table*> TableReader::tables_of(const char* name, bool required, const std::string& allowed,
                                                       const std::string& meaning) {
  const Key key = asked({name, "-", "list of tables", "", allowed, meaning, {}, {}, required});
  const toml::node* node = find(key);
  std::vector<const toml::table*> list;
  if (node == nullptr) return list;
  if (!node->is_array_of_tables()) {
    mistake(name, "is not a list of tables; allowed: " + key.allowed() + "; write [[stage." + name +
                      "]] with its keys below");
    return list;
  }
  for (const auto& item : *node->as_array()) list.push_back(item.as_table());
  return list;
}

void TableReader::finish() {
  std::vector<std::string> names;
  for (const Key& key : known_) names.push_back(key.name);
  const std::string prefix = dotted("");
  for (const auto& [key, value] : table_) {
    const std::string name(key.str());
    if (holds(names, name)) continue;
    if (const auto answer = in_another_unit(name, known_)) {
      errors_.push_back(key_error(place_of(key, value), prefix + shortened(name) + " is not known; write " + prefix +
                                                            answer->key.name + ", " + answer->factor));
    } else {
      refuse_unknown(place_of(key, value), prefix, name, names, errors_);
    }
  }
}

std::vector<Key> TableReader::keys() const {
  std::vector<Key> all = known_;
  all.insert(all.end(), inner_keys_.begin(), inner_keys_.end());
  return all;
}

}  // namespace rvelab::keys
