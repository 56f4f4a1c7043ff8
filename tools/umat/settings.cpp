#include "tools/umat/settings.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <stdexcept>
#include <string_view>

#include "rvelab/io/utf8.hpp"
#include "rvelab/keys/shortened.hpp"
#include "rvelab/keys/toml_source.hpp"

namespace umat {

namespace {

/// A value of the file, in a message.
std::string shown(const std::string& text) { return rvelab::keys::shortened(rvelab::io::printable(text)); }

/// One table of the file, with messages of its errors.
struct Table {
  const std::string& path;
  std::string name;
  const toml::table& keys;

  [[noreturn]] void refuse(const std::string& key, const std::string& what) const {
    const toml::node* const node = keys.get(key);
    const auto line = node == nullptr ? keys.source().begin.line : node->source().begin.line;
    throw std::runtime_error(path + ", line " + std::to_string(line) + ": " + name + "." + shown(key) + " " + what);
  }
  void expect_keys(std::initializer_list<std::string_view> allowed) const {
    std::string words;
    for (const std::string_view key : allowed) words += (words.empty() ? "" : ", ") + std::string(key);
    for (const auto& [key, node] : keys) {
      bool known = false;
      for (const std::string_view name_allowed : allowed) known = known || key == name_allowed;
      if (!known) refuse(std::string(key.str()), "is no key; allowed: " + words + "; correct or remove it");
    }
  }
  std::string text(const std::string& key, const std::string& otherwise) const {
    const toml::node* const node = keys.get(key);
    if (node == nullptr) return otherwise;
    const auto found = node->value_exact<std::string>();
    if (!found) refuse(key, "is no text; put it into quotation marks");
    return *found;
  }
  bool choice(const std::string& key, const std::string& usual, const std::string& other) const {
    const std::string found = text(key, usual);
    if (found != usual && found != other)
      refuse(key, "is \"" + shown(found) + "\"; allowed: \"" + usual + "\" (the default) or \"" + other + "\"");
    return found == other;
  }
  std::optional<std::array<int, 3>> shear_order(const std::string& key) const {
    const std::string found = text(key, ""), axes[3] = {"12", "13", "23"};
    if (!keys.contains(key)) return std::nullopt;
    const std::string wanted = found == "abaqus" ? "12 13 23" : found == "kratos" ? "12 23 13" : found;
    std::array<int, 3> order{0, 1, 2};
    do {
      if (wanted == axes[order[0]] + " " + axes[order[1]] + " " + axes[order[2]]) return order;
    } while (std::next_permutation(order.begin(), order.end()));
    refuse(key,
           "is \"" + shown(found) +
               "\"; allowed: \"abaqus\" (12 13 23, the default), \"kratos\" (12 23 13), or \"23 13 12\" and so on");
  }
  void number(const std::string& key, double& to) const {
    const toml::node* const node = keys.get(key);
    if (node == nullptr) return;
    if (!node->is_number()) refuse(key, "is no number; give one");
    to = *node->value<double>();
  }
  std::int64_t whole(const std::string& key, std::int64_t least) const {
    const toml::node* const node = keys.get(key);
    const auto found = node == nullptr ? std::nullopt : node->value_exact<std::int64_t>();
    if (!found) refuse(key, std::string(node == nullptr ? "is missing" : "is no whole number") + "; give one");
    if (*found < least || *found > 1'000'000'000)
      refuse(key, "is " + std::to_string(*found) + "; allowed: " + std::to_string(least) + " to 1000000000");
    return *found;
  }
};

}  // namespace

Settings read_settings(const std::string& path) {
  toml::table file;
  try {
    file = rvelab::keys::parse_toml_at(path);
  } catch (const toml::parse_error& error) {
    throw std::runtime_error(path + ", line " + std::to_string(error.source().begin.line) + ": " +
                             std::string(error.description()) +
                             "; correct it, or let RVELAB_UMAT name the file of the materials");
  } catch (const rvelab::InputError& error) {
    throw std::runtime_error(std::string(error.what()) + ", or let RVELAB_UMAT name the file of the materials");
  }
  Settings settings;
  settings.path = path;
  if (rvelab_pool_def_init(&settings.pool, sizeof settings.pool) < RVELAB_OK)
    throw std::runtime_error(rvelab_last_error());
  settings.pool.workers = 1;  // the host's threads do the work
  const Table whole{settings.path, "file", file};
  whole.expect_keys({"pool", "material"});
  if (const toml::node* const node = file.get("pool"); node != nullptr) {
    if (!node->is_table()) whole.refuse("pool", "is no table; write [pool]");
    const Table table{settings.path, "pool", *node->as_table()};
    table.expect_keys({"trial_memory", "tolerance_rel", "tolerance_abs", "max_substeps", "damping", "min_height"});
    settings.pool.trial_memory =
        table.choice("trial_memory", "keep", "recompute") ? RVELAB_TRIAL_RECOMPUTE : RVELAB_TRIAL_KEEP;
    table.number("tolerance_rel", settings.pool.tolerance_rel);
    table.number("tolerance_abs", settings.pool.tolerance_abs);
    table.number("damping", settings.pool.damping);
    table.number("min_height", settings.pool.min_height);
    if (table.keys.contains("max_substeps")) settings.pool.max_substeps = table.whole("max_substeps", 1);
  }
  const toml::array* const materials = file.get_as<toml::array>("material");
  if (materials == nullptr || !materials->is_homogeneous(toml::node_type::table))
    whole.refuse("material", "is missing or no list of tables; write one [[material]] for each PROPS(1)");
  for (const toml::node& node : *materials) {
    const Table table{settings.path, "material", *node.as_table()};
    table.expect_keys({"number", "specimen", "tangent", "shear_order", "initial_stress"});
    Material material;
    const std::string specimen = table.text("specimen", "");
    if (specimen.empty()) table.refuse("specimen", "is missing; give the path of a specimen file (rvelab pack)");
    material.specimen = (std::filesystem::absolute(path).parent_path() / specimen).string();
    material.kirchhoff = table.choice("tangent", "cauchy", "kirchhoff");
    material.from_zero = table.choice("initial_stress", "host", "specimen");
    material.shear_order = table.shear_order("shear_order");
    const int number = int(table.whole("number", 1));
    if (!settings.materials.emplace(number, material).second)
      table.refuse("number", "is " + std::to_string(number) + " a second time; give each material its own");
  }
  return settings;
}

}  // namespace umat
