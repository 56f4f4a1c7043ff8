#include "tools/mpm/keys.hpp"

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

std::string place(const std::string& path, const toml::node* node) {
  const auto line = node == nullptr ? 0 : node->source().begin.line;
  return line == 0 ? path + ": " : path + ":" + std::to_string(line) + ": ";
}

std::string as_text(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

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
  throw Mistake(place(path_, table_->get(name)) + dotted(name) + " " + message);
}

void Keys::missing(const std::string& name) const {
  throw Mistake(place(path_, table_) + "the key " + dotted(name) + " is missing; it has no default: give it a value");
}

double Keys::number(const std::string& name, double initial, double least, double most) {
  const auto* node = get(name);
  if (node == nullptr) return initial;
  if (!node->is_number()) wrong(name, "must be a number");
  const double value = *node->value<double>();
  if (!(value >= least && value <= most)) {
    wrong(name, "is " + as_text(value) + "; allowed: " + as_text(least) + " to " + as_text(most));
  }
  return value;
}

double Keys::number(const std::string& name) {
  if (get(name) == nullptr) missing(name);
  return number(name, 0);
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
  if (get(name) == nullptr) missing(name);
  return text(name, "");
}

std::string Keys::choice(const std::string& name, const std::vector<std::string>& allowed, bool required) {
  if (required && get(name) == nullptr) {
    throw Mistake(place(path_, table_) + "the key " + dotted(name) + " is missing; allowed: " + listed(allowed));
  }
  const std::string value = text(name, allowed.front());
  const std::set<std::string> words(allowed.begin(), allowed.end());
  if (words.contains(value)) return value;
  wrong(name, "is \"" + value + "\"; the nearest allowed value is \"" + nearest_word(value, words) +
                  "\" (allowed: " + listed(allowed) + ")");
}

std::vector<double> Keys::vector(const std::string& name, std::size_t size, const std::vector<double>& initial) {
  const auto* node = get(name);
  if (node == nullptr && initial.empty()) missing(name);
  if (node == nullptr) return initial;
  if (node->is_number()) return std::vector<double>(size, *node->value<double>());
  const auto* array = node->as_array();
  std::vector<double> values;
  if (array != nullptr) {
    for (const auto& each : *array) {
      if (each.is_number()) values.push_back(*each.value<double>());
    }
  }
  if (array == nullptr || values.size() != size || array->size() != size) {
    wrong(name, "must be " + std::to_string(size) + " numbers in brackets, one for each axis");
  }
  return values;
}

std::vector<std::vector<double>> Keys::rows(const std::string& name, std::size_t size) {
  const auto* node = get(name);
  std::vector<std::vector<double>> rows;
  if (node == nullptr) return rows;
  const auto* array = node->as_array();
  if (array == nullptr) wrong(name, "must be a list of rows of " + std::to_string(size) + " numbers");
  for (const auto& each : *array) {
    std::vector<double> row;
    if (const auto* inner = each.as_array()) {
      for (const auto& value : *inner) {
        if (value.is_number()) row.push_back(*value.value<double>());
      }
      if (row.size() != inner->size()) row.clear();
    }
    if (row.size() != size) wrong(name, "must be rows of " + std::to_string(size) + " numbers each");
    rows.push_back(row);
  }
  return rows;
}

std::vector<std::string> Keys::texts(const std::string& name) {
  const auto* node = get(name);
  if (node == nullptr) missing(name);
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
  if (array == nullptr || !array->is_homogeneous<toml::table>()) {
    wrong(name, "must be tables in double brackets: [[" + dotted(name) + "]]");
  }
  for (const auto& each : *array) list.emplace_back(*each.as_table(), path_, dotted(name));
  return list;
}

void Keys::finish() const {
  for (const auto& [key, node] : *table_) {
    const std::string name(key.str());
    if (known_.contains(name)) continue;
    const auto nearest = nearest_word(name, known_);
    throw Mistake(place(path_, &node) + "unknown key " + dotted(name) + "; the nearest known key is " +
                  dotted(nearest) + "; correct the name or remove it");
  }
}

toml::table parse_file(const std::string& path) {
  try {
    return toml::parse_file(path);
  } catch (const toml::parse_error& error) {
    std::ostringstream text;
    text << path;
    if (error.source().begin.line > 0) text << ":" << error.source().begin.line << ":" << error.source().begin.column;
    text << ": " << error.description();
    throw Mistake(text.str());
  }
}

void lay_over(toml::table& base, const toml::table& over) {
  for (const auto& [key, node] : over) {
    auto* mine = base.get(key.str());
    if (mine != nullptr && mine->is_table() && node.is_table()) {
      lay_over(*mine->as_table(), *node.as_table());
      continue;
    }
    if (mine != nullptr && mine->is_array_of_tables() && node.is_array_of_tables()) {
      auto& list = *mine->as_array();
      const auto& other = *node.as_array();
      for (std::size_t k = 0; k < other.size(); ++k) {
        if (k < list.size()) {
          lay_over(*list[k].as_table(), *other[k].as_table());
        } else {
          list.push_back(*other[k].as_table());
        }
      }
      continue;
    }
    base.insert_or_assign(key.str(), node);
  }
}

void assign(toml::table& scene, const std::string& assignment) {
  const auto equals = assignment.find('=');
  if (equals == std::string::npos) throw Mistake("--set " + assignment + ": give it as table.key=value");
  const std::string value = assignment.substr(equals + 1);
  toml::table parsed;
  try {
    parsed = toml::parse("value = " + value);
  } catch (const toml::parse_error&) {
    parsed.insert("value", value);  // a word without its quotation marks
  }
  std::vector<std::string> names;
  std::istringstream dotted(assignment.substr(0, equals));
  for (std::string name; std::getline(dotted, name, '.');) names.push_back(name);
  toml::table* at = &scene;
  for (std::size_t k = 0; k + 1 < names.size(); ++k) {
    if (!at->contains(names[k])) at->insert(names[k], toml::table{});
    auto* node = at->get(names[k]);
    if (node->is_table()) {
      at = node->as_table();
      continue;
    }
    toml::table* found = nullptr;
    if (auto* list = node->as_array(); list != nullptr && k + 2 < names.size()) {
      for (auto& each : *list) {
        auto* table = each.as_table();
        if (table != nullptr && (*table)["name"].value<std::string>() == names[k + 1]) found = table;
      }
    }
    if (found == nullptr) {
      throw Mistake("--set " + assignment + ": no [[" + names[k] + "]] of that name; give it as " + names[k] +
                    ".NAME.key=value");
    }
    at = found;
    ++k;
  }
  at->insert_or_assign(names.back(), *parsed.get("value"));
}

}  // namespace mpm
