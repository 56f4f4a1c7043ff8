// Keys whose values are lists or tables. Declared in table_reader.hpp.
#include <algorithm>
#include <cmath>

#include "rvelab/keys/table_reader.hpp"

namespace rvelab::keys {

std::vector<double> TableReader::numbers(const std::string& name) {
  const TableKey& key = entry(name);
  const toml::node* node = find(key, false);
  std::vector<double> values;
  if (node == nullptr) return values;
  if (!node->is_array() || node->as_array()->empty()) {
    mistake(name, "is not a list of numbers; allowed: " + key.key.allowed() + "; write it as [1e4, 2e4]");
    return values;
  }
  for (const auto& item : *node->as_array()) values.push_back(checked(key, item).value_or(0));
  resolved_.insert_or_assign(name, *node);
  return values;
}

std::vector<std::string> TableReader::choices(const std::string& name) {
  const TableKey& key = entry(name);
  const toml::node* node = find(key, false);
  std::vector<std::string> values;
  if (node == nullptr) return values;
  const auto known = [&](const toml::node& item) {
    return item.is_string() &&
           std::find(key.choices.begin(), key.choices.end(), item.as_string()->get()) != key.choices.end();
  };
  const std::string remedy = "write it as [\"" + key.choices.front() + "\"]";
  if (!node->is_array()) {
    mistake(name, "is not a list of known choices; allowed: " + key.key.allowed() + "; " + remedy);
    return values;
  }
  for (const auto& item : *node->as_array()) {
    if (known(item)) continue;
    const std::string word = item.is_string() ? item.as_string()->get() : written(item);
    mistake(name, "is not a list of known choices; allowed: " + key.key.allowed() + "; " + word +
                      " is none of them, the nearest is " + nearest(word, key.choices) + "; " + remedy);
    return values;
  }
  for (const auto& item : *node->as_array()) values.push_back(item.as_string()->get());
  resolved_.insert_or_assign(name, *node);
  return values;
}

Matrix3 TableReader::components(const std::string& name, bool symmetric) {
  const TableKey& key = entry(name);
  const toml::node* node = find(key, key.key.required);
  Matrix3 tensor = Matrix3::Zero();
  if (node == nullptr) return tensor;
  if (!node->is_table() || node->as_table()->empty()) {
    mistake(name, "is not a table of components; allowed: " + key.key.allowed() + "; write it as {xx = 1, xy = 0.5}");
    return tensor;
  }
  for (const auto& [component, value] : *node->as_table()) {
    const std::string axes(component.str());
    const bool known = axes.size() == 2 && axes.find_first_not_of("xyz") == std::string::npos;
    if (!known || (symmetric && axes[0] > axes[1])) {
      mistake(name, "names no component \"" + axes + "\"; allowed: " + key.key.allowed() + "; correct it");
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

std::vector<Matrix3> TableReader::matrices(const std::string& name) {
  const TableKey& key = entry(name);
  const toml::node* node = find(key, key.key.required);
  std::vector<Matrix3> list;
  if (node == nullptr) return list;
  const auto good = [](const toml::node& item) {
    return item.is_array() && (item.as_array()->size() == 4 || item.as_array()->size() == 9) &&
           std::all_of(item.as_array()->begin(), item.as_array()->end(),
                       [](const toml::node& each) { return each.is_number() && std::isfinite(number_in(each)); });
  };
  if (!node->is_array() || node->as_array()->empty() ||
      !std::all_of(node->as_array()->begin(), node->as_array()->end(), good)) {
    mistake(name, "is not a list of matrices; allowed: " + key.key.allowed() + "; write it as [[1, 0, 0, 0.99]]");
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

std::vector<const toml::table*> TableReader::tables(const std::string& name) {
  const TableKey& key = entry(name);
  const toml::node* node = find(key, key.key.required);
  std::vector<const toml::table*> list;
  if (node == nullptr) return list;
  if (!node->is_array_of_tables()) {
    mistake(name, "is not a list of tables; allowed: " + key.key.allowed() + "; write [[stage." + name +
                      "]] with its keys below");
    return list;
  }
  for (const auto& item : *node->as_array()) list.push_back(item.as_table());
  return list;
}

}  // namespace rvelab::keys
