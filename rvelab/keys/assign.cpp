#include "rvelab/keys/assign.hpp"

#include <algorithm>
#include <charconv>

#include "rvelab/error.hpp"
#include "rvelab/keys/shortened.hpp"
#include "rvelab/keys/toml_source.hpp"

namespace rvelab::keys {
namespace {

/// "a.b.c" into its parts.
std::vector<std::string> parts_of(const std::string& key) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= key.size();) {
    const auto end = std::min(key.find('.', begin), key.size());
    parts.push_back(trimmed(key.substr(begin, end - begin)));
    begin = end + 1;
  }
  return parts;
}

std::string stage_name(const toml::node& stage) {
  const toml::table* table = stage.as_table();
  if (table == nullptr) return "";
  return (*table)["name"].value_or(std::string((*table)["kind"].value_or("")));
}

/// One table of a list, by its name (a stage without one: its kind) or its number from 0.
toml::table& find_in(toml::array* stages, const std::string& list, const std::string& which,
                     const std::string& assignment) {
  std::string known;
  std::vector<toml::table*> found;
  if (stages != nullptr) {
    std::size_t wanted = stages->size();
    const auto [end, error] = std::from_chars(which.data(), which.data() + which.size(), wanted);
    const bool by_number = error == std::errc() && end == which.data() + which.size();
    for (std::size_t k = 0; k < stages->size(); ++k) {
      toml::node& stage = *stages->get(k);
      known += (known.empty() ? "" : ", ") + std::to_string(k) + " (" + stage_name(stage) + ")";
      if (stage.is_table() && (by_number ? wanted == k : stage_name(stage) == which)) found.push_back(stage.as_table());
    }
  }
  if (found.size() == 1) return *found[0];
  throw InputError("--set " + assignment + " names " + (found.empty() ? "no " : "several of ") + list +
                   "; allowed: " + (known.empty() ? "none, since the protocol has no [[" + list + "]]" : known) +
                   "; give the name or the number of one");
}

/// Puts the value of an assignment into a table, in place of what is there.
void put(toml::table& table, const std::string& key, const std::string& text, const std::string& assignment) {
  // Of two keys for one quantity the assigned one stands.
  if (key == "friction") table.erase("friction_angle_deg");
  if (key == "friction_angle_deg") table.erase("friction");
  // A node that is moved keeps its source, so that a mistake in it names the assignment.
  toml::table value = parsed_value(text, assignment);
  toml::node& node = *value.get("value");
  const toml::source_region source = node.source();
  node.visit([&](auto& concrete) { table.insert_or_assign(toml::key(key, source), std::move(concrete)); });
}

}  // namespace

void assign(toml::table& file, const std::string& assignment) {
  const auto equals = assignment.find('=');
  const std::string key = trimmed(assignment.substr(0, equals));
  const auto parts = parts_of(key);
  const bool incomplete =
      parts.size() < 2 || parts.size() > most_names || std::find(parts.begin(), parts.end(), "") != parts.end();
  if (equals == std::string::npos || trimmed(assignment.substr(equals + 1)).empty() || incomplete) {
    throw InputError(
        "--set " + shortened(assignment) +
        " is not an assignment; allowed: table.key=value, of up to 8 names; write for example test.pressure_Pa=2e4");
  }
  const std::string text = trimmed(assignment.substr(equals + 1));
  toml::table* table = &file;
  std::size_t next = 0;
  if (parts[0] == "stage") {
    if (parts.size() < 3) {
      throw InputError("--set " + assignment +
                       " names no key of a stage; allowed: stage.NAME.key=value; write for example "
                       "stage.compression.to_strain=0.05");
    }
    table = &find_in(file["stage"].as_array(), "stage", parts[1], assignment);
    next = 2;
  }
  for (; next + 1 < parts.size(); ++next) {
    if (!table->contains(parts[next])) table->insert(parts[next], toml::table{});
    toml::node* inner = table->get(parts[next]);
    if (inner->is_array_of_tables() && next + 2 < parts.size()) {
      table = &find_in(inner->as_array(), parts[next], parts[next + 1], assignment);
      ++next;
      continue;
    }
    if (inner->is_array_of_tables() && parts[next] == "material") {  // material.key: all of them
      for (toml::node& material : *inner->as_array()) put(*material.as_table(), parts.back(), text, assignment);
      return;
    }
    if (!inner->is_table()) {
      throw InputError("--set " + assignment + ": " + parts[next] +
                       " is no table in the protocol; allowed: table.key=value; correct the key");
    }
    table = inner->as_table();
  }
  put(*table, parts.back(), text, assignment);
}

void assign_all(toml::table& file, const std::vector<std::string>& assignments, std::vector<KeyError>& errors) {
  for (const std::string& assignment : assignments) {
    try {
      assign(file, assignment);
    } catch (const InputError& error) {
      errors.push_back({0, error.what(), true});
    }
  }
}

}  // namespace rvelab::keys
