// Scene files, and what overrides them: cases, and assignments of the command line. Declared in keys.hpp.
#include <algorithm>
#include <filesystem>
#include <sstream>

#include "rvelab/keys/toml_source.hpp"
#include "tools/mpm/keys/keys.hpp"

namespace mpm {
namespace {

/// How the tables of an array are reached.
std::string choices(const toml::array& tables, const std::string& array) {
  std::string list;
  for (std::size_t n = 0; n < tables.size(); ++n) {
    const auto name = (*tables[n].as_table())["name"].value<std::string>();
    list += (n == 0 ? "give " : " or ") + array + "." + name.value_or(std::to_string(n)) + ".key=value";
  }
  return list;
}

}  // namespace

toml::table parse_file(const std::string& path) {
  const std::filesystem::path file(path);
  if (std::error_code none; !std::filesystem::exists(file, none) || std::filesystem::is_directory(file, none)) {
    throw InputError(path + ": there is no such file; a scene goes by its path, such as protocols/mpm/" +
                     (file.extension().empty() && !file.stem().empty() ? file.stem().string() : "column_soil") +
                     ".toml");
  }
  try {
    return rvelab::keys::parse_toml_at(path);
  } catch (const toml::parse_error& error) {
    std::ostringstream text;
    text << path;
    if (error.source().begin.line > 0) text << ":" << error.source().begin.line << ":" << error.source().begin.column;
    text << ": " << error.description();
    throw InputError(text.str());
  } catch (const rvelab::InputError& error) {
    throw InputError(error.what());
  }
}

void override_table(toml::table& base, const toml::table& over) {
  for (const auto& [key, node] : over) {
    auto* mine = base.get(key.str());
    if (mine != nullptr && mine->is_table() && node.is_table()) {
      override_table(*mine->as_table(), *node.as_table());
      continue;
    }
    if (mine != nullptr && mine->is_array_of_tables() && node.is_array_of_tables()) {
      auto& list = *mine->as_array();
      const auto& other = *node.as_array();
      for (std::size_t k = 0; k < other.size(); ++k) {
        if (k < list.size()) {
          override_table(*list[k].as_table(), *other[k].as_table());
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
  if (equals == std::string::npos) throw InputError("--set " + assignment + ": give it as table.key=value");
  const std::string value = assignment.substr(equals + 1);
  toml::table parsed;
  try {
    parsed = rvelab::keys::parse_toml("value = " + value);
  } catch (const toml::parse_error&) {
    parsed.insert("value", value);  // a word without its quotation marks
  }
  std::vector<std::string> names;
  std::istringstream dotted(assignment.substr(0, equals));
  for (std::string name; std::getline(dotted, name, '.');) names.push_back(name);
  if (names.empty() || equals == 0 || assignment[equals - 1] == '.' ||
      std::find(names.begin(), names.end(), "") != names.end()) {
    throw InputError("--set " + assignment + ": there is a name missing before the =; give it as table.key=value");
  }
  if (names.size() > rvelab::keys::most_names) {
    throw InputError("--set " + assignment.substr(0, 60) + "...: has more than 8 names before the =; give up to 8");
  }
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
      for (std::size_t n = 0; n < list->size(); ++n) {
        auto* table = list->get(n)->as_table();
        if (table == nullptr) continue;
        const auto given = (*table)["name"].value<std::string>();
        if (given == names[k + 1] || (found == nullptr && std::to_string(n) == names[k + 1])) found = table;
      }
    }
    if (found == nullptr && node->is_array_of_tables()) {
      throw InputError("--set " + assignment + ": no [[" + names[k] + "]] of that name; " +
                       choices(*node->as_array(), names[k]));
    }
    if (found == nullptr) {
      throw InputError("--set " + assignment + ": " + names[k] + " is no table; give it as table.key=value");
    }
    at = found;
    ++k;
  }
  at->insert_or_assign(names.back(), *parsed.get("value"));
}

}  // namespace mpm
