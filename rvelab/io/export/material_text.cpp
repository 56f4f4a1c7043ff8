// The parameters of a specimen as the TOML file that read_material_file reads. Declared in export.hpp.
#include "rvelab/io/export/export.hpp"

#include <algorithm>
#include <sstream>

#include "rvelab/io/publish.hpp"
#include "rvelab/keys/material_toml.hpp"
#include "rvelab/specimen/field_layout.hpp"

namespace rvelab::io {
namespace {

/// Of keys that share a field the one that is read; where none is, the first of them.
bool in_use(const Specimen& specimen, const keys::KeyEntry& entry) {
  if (entry.as_tangent) return false;  // said by friction
  const std::string read = keys::key_in_use(specimen, entry.key.name);
  if (!read.empty()) return entry.key.name == read;
  const auto& all = keys::key_entries();
  const auto first =
      std::find_if(all.begin(), all.end(), [&](const auto& each) { return each.target == entry.target; });
  return &*first == &entry;
}

std::string table_text(const Specimen& specimen, const Material& material, const std::string& table) {
  std::ostringstream text;
  for (const keys::KeyEntry& entry : keys::key_entries()) {
    if (entry.key.table != table || !in_use(specimen, entry)) continue;
    keys::with_field(entry, specimen, material, [&]<class Value>(const Value& value) {
      if constexpr (std::is_same_v<Value, bool>) {
        text << entry.key.name << " = " << (value ? "true" : "false") << "\n";
      } else if constexpr (std::is_arithmetic_v<Value>) {
        // A default that no file may state (a modulus of 0) is left out.
        if (!entry.key.interval.contains(double(value))) return;
        if constexpr (std::is_same_v<Value, double>) text << entry.key.name << " = " << exact(value) << "\n";
        if constexpr (std::is_same_v<Value, long>) text << entry.key.name << " = " << value << "\n";
      } else {
        text << entry.key.name << " = " << toml::value<std::string>(fields::text_of(value)) << "\n";
      }
    });
  }
  return text.str();
}

}  // namespace

std::string material_file_text(const Specimen& specimen) {
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

}  // namespace rvelab::io
