#include "tools/mpm/keys/keys.hpp"

#include <cctype>
#include <cmath>
#include <numeric>
#include <sstream>

namespace mpm {
namespace {

std::string listed(const std::vector<std::string>& words) {
  std::string list;
  for (const auto& word : words) list += (list.empty() ? "" : ", ") + word;
  return list;
}

std::size_t edits(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t corner = row[0]++;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t next = std::min({row[j] + 1, row[j - 1] + 1, corner + (a[i - 1] != b[j - 1])});
      corner = row[j];
      row[j] = next;
    }
  }
  return row.back();
}

std::string location(const std::string& path, const toml::node* node) {
  const auto line = node == nullptr ? 0 : node->source().begin.line;
  return line == 0 ? path + ": " : path + ":" + std::to_string(line) + ": ";
}

/// "allowed: 0 to 1e+13 Pa; ..."
std::string allowed_between(double least, double most, const Range& range) {
  const std::string unit = *range.unit == 0 ? "" : std::string(" ") + range.unit;
  return "; allowed: " + text_of(least) + " to " + text_of(most) + unit + "; give a number within" +
         (unit.empty() ? "" : ", in" + unit);
}

constexpr const char* no_default = "it has no default: give it a value";

}  // namespace

std::string nearest_word(const std::string& word, const std::set<std::string>& words) {
  std::string best;
  for (const auto& each : words) {
    if (best.empty() || edits(word, each) < edits(word, best)) best = each;
  }
  return best;
}

Keys::Keys(const toml::table& table, std::string path, std::string where)
    : table_(&table), path_(std::move(path)), where_(std::move(where)) {}

const toml::node* Keys::get(const std::string& name) {
  known_.insert(name);
  return table_->get(name);
}

void Keys::wrong(const std::string& name, const std::string& message) const {
  throw InputError(location(path_, table_->get(name)) + dotted(name) + " " + message);
}

void Keys::missing(const std::string& name, const std::string& remedy) {
  if (missing_.empty()) missing_ = location(path_, table_) + "the key " + dotted(name) + " is missing; " + remedy;
}

double Keys::within(const std::string& name, const toml::node& value, const Range& range) const {
  const double number = *value.value<double>();
  if (!std::isfinite(number)) wrong(name, "holds " + text_of(number) + "; give numbers that are finite");
  if (!(std::abs(number) <= range.most))
    wrong(name, "holds " + text_of(number) + allowed_between(-range.most, range.most, range));
  return number;
}

void Keys::expect_positive(const std::string& name, double value) const {
  const auto range = range_of(name);
  if (value <= 0) wrong(name, "is " + text_of(value) + "; it must be positive");
  if (!(value >= range.least && value <= range.most))
    wrong(name, "is " + text_of(value) + allowed_between(range.least, range.most, range));
}

double Keys::number(const std::string& name, double initial, double least, double most) {
  const auto* node = get(name);
  if (node == nullptr) return initial;
  if (!node->is_number()) wrong(name, "must be a number");
  const double value = *node->value<double>();
  const auto range = range_of(name);
  least = std::max(least, -range.most);
  most = std::min(most, range.most);
  if (!(value >= least && value <= most)) wrong(name, "is " + text_of(value) + allowed_between(least, most, range));
  return value;
}

double Keys::number(const std::string& name) {
  if (get(name) == nullptr) missing(name, no_default);
  return number(name, 0);
}

double Keys::positive(const std::string& name) {
  const auto* node = get(name);
  if (node == nullptr || !node->is_number()) return number(name);
  const double value = *node->value<double>();
  expect_positive(name, value);
  return value;
}

long Keys::whole_number(const std::string& name, long initial, long least, long most) {
  const auto* node = get(name);
  if (node == nullptr) return initial;
  if (!node->is_integer()) wrong(name, "must be a whole number");
  const auto value = *node->value<std::int64_t>();
  if (value < least || value > most) {
    wrong(name, "is " + std::to_string(value) + "; allowed: " + std::to_string(least) + " to " + std::to_string(most));
  }
  return long(value);
}

bool Keys::boolean(const std::string& name, bool initial) {
  const auto* node = get(name);
  if (node == nullptr) return initial;
  if (!node->is_boolean()) wrong(name, "must be true or false");
  return *node->value<bool>();
}

std::string Keys::text(const std::string& name, const std::string& initial) {
  const auto* node = get(name);
  if (node == nullptr) return initial;
  if (!node->is_string()) wrong(name, "must be a text in quotation marks");
  return *node->value<std::string>();
}

std::string Keys::text(const std::string& name) {
  if (get(name) == nullptr) missing(name, no_default);
  return text(name, "");
}

std::string Keys::name() {
  const auto value = text("name");
  const auto allowed = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; };
  if (has("name") && (value.empty() || !std::all_of(value.begin(), value.end(), allowed))) {
    wrong("name", "is \"" + value + "\"; columns and files go by it: give letters, digits, _ and - alone");
  }
  return value;
}

std::string Keys::choice(const std::string& name, const std::vector<std::string>& allowed, bool required) {
  if (required && get(name) == nullptr) {
    missing(name, "allowed: " + listed(allowed));
    // Which keys belong here hangs on this one: of the others only one that is nearly it can be called unknown.
    for (const auto& [key, node] : *table_) {
      const std::string other(key.str());
      if (!known_.contains(other) && edits(other, name) <= 2) throw InputError(unknown(other, node, dotted(name)));
    }
    throw InputError(missing_);
  }
  const std::string value = text(name, allowed.front());
  const std::set<std::string> words(allowed.begin(), allowed.end());
  if (words.contains(value)) return value;
  wrong(name, "is \"" + value + "\"; the nearest allowed value is \"" + nearest_word(value, words) +
                  "\" (allowed: " + listed(allowed) + ")");
}

std::vector<double> Keys::list(const std::string& name, std::size_t size, const std::string& what) const {
  const auto* array = table_->get(name)->as_array();
  std::vector<double> values;
  if (array != nullptr) {
    for (const auto& each : *array) {
      if (each.is_number()) values.push_back(within(name, each, range_of(name)));
    }
  }
  if (array == nullptr || values.size() != size || array->size() != size) {
    wrong(name, "must be " + std::to_string(size) + " numbers in brackets" + what);
  }
  return values;
}

std::vector<double> Keys::vector(const std::string& name, std::size_t axes, const std::vector<double>& initial,
                                 bool one_for_all) {
  const auto* node = get(name);
  if (node == nullptr && initial.empty()) missing(name, no_default);
  if (node == nullptr) return initial.empty() ? std::vector<double>(axes, 0) : initial;
  if (one_for_all && node->is_number()) return std::vector<double>(axes, within(name, *node, range_of(name)));
  return list(name, axes, one_for_all ? ", one for each axis, or one number for all" : ", one for each axis");
}

std::vector<double> Keys::numbers(const std::string& name, std::size_t size) {
  if (get(name) != nullptr) return list(name, size, "");
  missing(name, no_default);
  return std::vector<double>(size, 0);
}

std::vector<std::vector<double>> Keys::rows(const std::string& name, std::size_t size,
                                            const std::vector<std::string>& units) {
  const auto* node = get(name);
  std::vector<std::vector<double>> rows;
  if (node == nullptr) return rows;
  const auto* array = node->as_array();
  if (array == nullptr) wrong(name, "must be a list of rows of " + std::to_string(size) + " numbers");
  for (const auto& each : *array) {
    std::vector<double> row;
    if (const auto* inner = each.as_array()) {
      for (const auto& value : *inner) {
        const auto column = std::min(row.size(), units.size() - 1);  // of no units any
        if (value.is_number()) row.push_back(within(name, value, range_of(units.empty() ? name : units[column])));
      }
      if (row.size() != inner->size()) row.clear();
    }
    if (row.size() != size) wrong(name, "must be rows of " + std::to_string(size) + " numbers each");
    rows.push_back(row);
  }
  return rows;
}

std::size_t Keys::row_length(const std::string& name) const {
  const auto* rows = table_->get_as<toml::array>(name);
  const auto* first = rows == nullptr || rows->empty() ? nullptr : rows->front().as_array();
  return first == nullptr ? 0 : first->size();
}

std::vector<std::string> Keys::texts(const std::string& name) {
  const auto* node = get(name);
  if (node == nullptr) missing(name, no_default);
  if (node == nullptr) return {};
  if (node->is_string()) return {*node->value<std::string>()};
  std::vector<std::string> texts;
  if (const auto* array = node->as_array()) {
    for (const auto& each : *array) {
      if (each.is_string()) texts.push_back(*each.value<std::string>());
    }
    if (texts.size() == array->size() && !texts.empty()) return texts;
  }
  wrong(name, "must be one or more texts in brackets");
}

Keys Keys::table(const std::string& name) {
  static const toml::table none;
  const auto* node = get(name);
  if (node == nullptr) return Keys(none, path_, dotted(name));
  if (!node->is_table()) wrong(name, "must be a table: [" + dotted(name) + "]");
  return Keys(*node->as_table(), path_, dotted(name));
}

std::vector<Keys> Keys::tables(const std::string& name) {
  const auto* node = get(name);
  std::vector<Keys> list;
  if (node == nullptr) return list;
  const auto* array = node->as_array();
  if (array != nullptr && array->empty()) return list;  // --set region=[] takes them away
  if (array == nullptr || !array->is_homogeneous<toml::table>()) {
    wrong(name, "must be tables in double brackets: [[" + dotted(name) + "]]");
  }
  for (const auto& each : *array) list.emplace_back(*each.as_table(), path_, dotted(name));
  return list;
}

std::string Keys::unknown(const std::string& name, const toml::node& node, const std::string& nearest) const {
  return location(path_, &node) + "unknown key " + dotted(name) + "; the nearest known key is " + nearest +
         "; correct the name or remove it";
}

void Keys::finish() const {
  std::string first, others;
  for (const auto& [key, node] : *table_) {
    const std::string name(key.str());
    if (known_.contains(name)) continue;
    const auto nearest = dotted(nearest_word(name, known_));
    if (first.empty()) {
      first = unknown(name, node, nearest);
    } else {
      others += (others.empty() ? "; unknown too: " : ", ") + dotted(name) + " (" + nearest + ")";
    }
  }
  if (!first.empty()) throw InputError(first + others);
  if (!missing_.empty()) throw InputError(missing_);
}

}  // namespace mpm
