#include "tools/mpm/keys/keys.hpp"

#include <algorithm>
#include <cctype>

#include "rvelab/contact/interval_words.hpp"

namespace mpm {
namespace {

namespace keys = rvelab::keys;

rvelab::Interval interval_of(const Range& range) { return {range.least, range.most}; }

/// Of numbers of either sign.
Range both_signs(const std::string& key) {
  const auto range = range_of(key);
  return {range.unit, -range.most, range.most};
}

/// What is wrong with one of several numbers of a key; "" if nothing is.
std::string fault_of(const toml::node& number, const Range& range) {
  const auto interval = interval_of(range);
  const auto bad =
      keys::wrong_with(number, {"", "", range.unit, "number", "", rvelab::in_words(interval), "", interval});
  return bad.empty() ? "" : "holds " + keys::written(number) + ", which " + bad;
}

/// Raises those of missing keys too.
void raise_all(const std::string& path, std::vector<keys::KeyError>& errors) {
  for (auto& error : errors) error.doubt = false;
  keys::raise(path, errors);
}

}  // namespace

Keys::Keys(const toml::table& table, std::string path, std::string where)
    : path_(std::move(path)),
      errors_(std::make_shared<std::vector<keys::KeyError>>()),
      reader_(table, where, where, keys::line_of(table), *errors_) {}

std::string Keys::dotted(const std::string& name) const {
  return reader_.where().empty() ? name : reader_.where() + "." + name;
}

void Keys::wrong(const std::string& name, const std::string& message) const {
  const auto* node = reader_.table().get(name);
  const std::string text = dotted(name) + " " + message;
  errors_->push_back(node == nullptr ? keys::KeyError{0, text} : keys::key_error(node->source(), text));
  keys::raise(path_, *errors_);
  throw InputError(text);  // not reached: there is an error
}

/// The error of a key that is not there waits for finish(), as a doubt, which keys::raise passes by.
void Keys::expect_good(const std::string& name) const {
  if (has(name)) return keys::raise(path_, *errors_);
  for (auto& error : *errors_) error.doubt = true;
}

double Keys::number(const std::string& name, const Range& range, bool required, double initial) {
  double value = initial;
  if (required) {
    reader_.required_number(name.c_str(), value, range.unit, interval_of(range), "");
  } else {
    value = reader_.optional_number(name.c_str(), range.unit, interval_of(range), "").value_or(initial);
  }
  expect_good(name);
  return value;
}

double Keys::number(const std::string& name, double initial, double least, double most) {
  auto range = both_signs(name);
  range.least = std::max(least, range.least);
  range.most = std::min(most, range.most);
  return number(name, range, false, initial);
}

double Keys::number(const std::string& name) { return number(name, both_signs(name), true, 0); }

double Keys::positive(const std::string& name) { return number(name, range_of(name), true, 0); }

void Keys::expect_positive(const std::string& name, double value) const {
  const auto bad = fault_of(toml::value<double>(value), range_of(name));
  if (!bad.empty()) wrong(name, bad);
}

long Keys::whole_number(const std::string& name, long initial, long least, long most) {
  const auto value =
      reader_.optional_whole_number(name.c_str(), {double(least), double(most)}, "", "", "").value_or(initial);
  expect_good(name);
  return value;
}

bool Keys::boolean(const std::string& name, bool initial) {
  reader_.boolean(name.c_str(), initial, "");
  expect_good(name);
  return initial;
}

std::string Keys::text(const std::string& name, const std::string& initial) {
  std::string value = initial;
  reader_.text(name.c_str(), value, "");
  expect_good(name);
  return value;
}

std::string Keys::text(const std::string& name) {
  const auto value = reader_.required_text(name.c_str(), "");
  expect_good(name);
  return value;
}

std::string Keys::name() {
  const auto value = text("name");
  const auto allowed = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; };
  if (!std::all_of(value.begin(), value.end(), allowed))
    wrong("name", "is \"" + value + "\"; columns and files go by it: give letters, digits, _ and - alone");
  return value;
}

std::string Keys::choice(const std::string& name, const std::vector<std::string>& allowed, bool required) {
  const auto word = required ? reader_.required_choice(name.c_str(), allowed, "")
                             : reader_.choice(name.c_str(), allowed.front(), allowed, "", "");
  expect_good(name);
  if (has(name) || !required) return word;
  // Which keys belong here hangs on this one: of the others only one that is nearly it can be called unknown.
  for (const auto& [key, node] : reader_.table()) {
    const std::string other(key.str());
    if (keys::near_one(other, {name}).empty()) continue;
    throw InputError(path_ + ":" + std::to_string(key.source().begin.line) + ": unknown key " + dotted(other) + "; " +
                     keys::what_was_meant(dotted(""), other, {name}));
  }
  raise_all(path_, *errors_);
  return word;
}

std::vector<double> Keys::vector(const std::string& name, std::size_t axes, const std::vector<double>& initial,
                                 bool one_for_all) {
  if (const auto* node = reader_.table().get(name); one_for_all && node != nullptr && node->is_number())
    return std::vector<double>(axes, number(name, both_signs(name), true, 0));
  if (!has(name) && !initial.empty()) {
    known(name);
    return initial;
  }
  return numbers(name, axes);
}

std::vector<double> Keys::numbers(const std::string& name, std::size_t size) {
  const auto range = both_signs(name);
  auto values = reader_.numbers(name.c_str(), range.unit, interval_of(range), "", nullptr, true);
  expect_good(name);
  if (has(name) && values.size() != size) wrong(name, "must be " + std::to_string(size) + " numbers in brackets");
  values.resize(size, 0.0);
  return values;
}

std::vector<std::vector<double>> Keys::rows(const std::string& name, std::size_t size,
                                            const std::vector<std::string>& units) {
  known(name);
  std::vector<std::vector<double>> rows;
  if (!has(name)) return rows;
  const auto* array = reader_.table().get_as<toml::array>(name);
  const std::string wanted = "must be a list of rows of " + std::to_string(size) + " numbers each";
  if (array == nullptr) wrong(name, wanted);
  for (const auto& each : *array) {
    const auto* inner = each.as_array();
    if (inner == nullptr || inner->size() != size) wrong(name, wanted);
    auto& row = rows.emplace_back();
    for (const auto& value : *inner) {
      const auto range = both_signs(units.empty() ? name : units[std::min(row.size(), units.size() - 1)]);
      if (const auto bad = fault_of(value, range); !bad.empty()) wrong(name, bad);
      row.push_back(keys::number_in(value));
    }
  }
  return rows;
}

std::size_t Keys::row_length(const std::string& name) const {
  const auto* rows = reader_.table().get_as<toml::array>(name);
  const auto* first = rows == nullptr || rows->empty() ? nullptr : rows->front().as_array();
  return first == nullptr ? 0 : first->size();
}

std::vector<std::string> Keys::texts(const std::string& name) {
  if (!has(name) || reader_.table().get(name)->is_string()) return {text(name)};
  const auto texts = reader_.texts(name.c_str(), "");
  expect_good(name);
  if (texts.empty()) wrong(name, "must be one or more texts in brackets");
  return texts;
}

Keys Keys::table(const std::string& name) {
  static const toml::table none;
  known(name);
  const auto* node = reader_.table().get(name);
  if (node == nullptr) return Keys(none, path_, dotted(name));
  if (!node->is_table()) wrong(name, "must be a table: [" + dotted(name) + "]");
  return Keys(*node->as_table(), path_, dotted(name));
}

std::vector<Keys> Keys::tables(const std::string& name) {
  known(name);
  std::vector<Keys> list;
  const auto* node = reader_.table().get(name);
  if (node == nullptr) return list;
  const auto* array = node->as_array();
  if (array != nullptr && array->empty()) return list;  // --set region=[] takes them away
  if (array == nullptr || !array->is_homogeneous<toml::table>())
    wrong(name, "must be tables in double brackets: [[" + dotted(name) + "]]");
  for (const auto& each : *array) list.emplace_back(*each.as_table(), path_, dotted(name));
  return list;
}

void Keys::finish() {
  reader_.finish();
  raise_all(path_, *errors_);
}

}  // namespace mpm
