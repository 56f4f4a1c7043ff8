#include "rvelab/keys/parameters.hpp"

#include <algorithm>
#include <utility>

#include "rvelab/error.hpp"
#include "rvelab/keys/material_toml.hpp"
#include "rvelab/keys/table_reader.hpp"
#include "rvelab/specimen/field_layout.hpp"
#include "rvelab/specimen/specimen_check.hpp"

namespace rvelab::keys {
namespace {

/// Of keys that share a field the one that is read; where none is, the first of them.
bool in_use(const Specimen& specimen, const KeyEntry& entry) {
  if (entry.as_tangent) return false;  // said by friction
  const std::string read = key_in_use(specimen, entry.key.name);
  if (!read.empty()) return entry.key.name == read;
  if (!laws_that_read(entry.key.name).empty()) return false;
  const auto& all = key_entries();
  const auto first =
      std::find_if(all.begin(), all.end(), [&](const auto& each) { return each.target == entry.target; });
  return &*first == &entry;
}

std::string table_text(const Specimen& specimen, const Material& material, const std::string& table) {
  TextStream text;
  for (const KeyEntry& entry : key_entries()) {
    if (entry.key.table != table || !in_use(specimen, entry)) continue;
    with_field(entry, specimen, material, [&]<class Value>(const Value& value) {
      if constexpr (std::is_same_v<Value, bool>) {
        text << entry.key.name << " = " << (value ? "true" : "false") << "\n";
      } else if constexpr (std::is_arithmetic_v<Value>) {
        // A default that no file may state (a modulus of 0) is left out.
        if (!entry.key.interval.contains(double(value))) return;
        if constexpr (std::is_same_v<Value, double>)
          text << entry.key.name << " = " << written(toml::value<double>(value)) << "\n";
        if constexpr (std::is_same_v<Value, long>) text << entry.key.name << " = " << value << "\n";
      } else {
        text << entry.key.name << " = " << toml::value<std::string>(fields::text_of(value)) << "\n";
      }
    });
  }
  return text.str();
}

/// The table of one material in a list [[material]], under its name.
void read_listed(Specimen& specimen, const toml::node& item, std::vector<KeyError>& errors) {
  const toml::table* table = item.as_table();
  const auto name = table == nullptr ? std::optional<std::string>() : (*table)["name"].value<std::string>();
  if (!name) {
    errors.push_back({line_of(item),
                      "a [[material]] without a name; allowed: name = \"...\" of a material of the specimen; "
                      "write it below [[material]]"});
    return;
  }
  read_table(specimen, "material." + *name, *table, errors);
}

}  // namespace

std::string parameters_text(const Specimen& specimen) {
  std::string text;
  const Material none;
  for (const char* table : {"contact", "damping", "solver"}) {
    text += std::string("[") + table + "]\n" + table_text(specimen, none, table) + "\n";
  }
  for (const Material& material : specimen.materials) {
    text += "[[material]]\n" + table_text(specimen, material, "material") + "\n";
  }
  return text;
}

void set_parameters(Specimen& specimen, const std::string& text) {
  const std::string path = "parameters";
  const toml::table file = parse_toml_text(text, path);
  std::vector<KeyError> errors;
  expect_material_tables(file, errors);
  Specimen changed = specimen;
  for (const char* name :
       {"contact", "damping", "solver", "material"}) {  // the law first: it says the unit of a stiffness
    const toml::node* node = file.get(name);
    if (node == nullptr) continue;
    if (const toml::table* table = node->as_table()) read_table(changed, name, *table, errors);
    if (const toml::array* list = node->as_array())
      for (const toml::node& item : *list) read_listed(changed, item, errors);
  }
  expect_keys_of_law(file, changed, errors);
  raise(path, errors);
  try {
    check_parameters(changed.contact, changed.damping, changed.materials);
  } catch (const InputError& error) {
    throw InputError(path + ": " + error.what());
  }
  fit_state_to_parameters(changed, specimen.contact, specimen.materials);
  specimen = std::move(changed);
}

}  // namespace rvelab::keys
