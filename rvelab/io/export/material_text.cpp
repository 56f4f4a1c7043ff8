#include "rvelab/io/export/material_text.hpp"

#include <algorithm>
#include <sstream>

#include "rvelab/io/text_file.hpp"
#include "rvelab/keys/enumerations.hpp"
#include "rvelab/keys/material_keys.hpp"

namespace rvelab::io {
namespace {

/// Keys that share a field and not its unit: the one that the law, or the dashpot, reads.
bool in_use(const Specimen& specimen, const std::string& name) {
  const bool viscoelastic = specimen.damping.dashpot == Dashpot::viscoelastic;
  // Where the law does not read the field, the first key of the field is used.
  const auto& all = law_parameters();
  const auto asked = std::find_if(all.begin(), all.end(), [&](const auto& each) { return name == each.parameter.key; });
  if (asked != all.end()) {
    const auto of_field = [&](const LawParameter& each) { return each.value == asked->value; };
    auto used = std::find_if(all.begin(), all.end(), [&](const LawParameter& each) {
      return of_field(each) && each.law == specimen.contact.law;
    });
    if (used == all.end()) used = std::find_if(all.begin(), all.end(), of_field);
    return name == used->parameter.key;
  }
  if (name == "normal_coefficient_N_s_m") return !viscoelastic;
  if (name == "viscoelastic_1_m_s") return viscoelastic;
  return true;
}

/// One line "key = value"; nothing where the field holds a default that no file may state (a modulus of 0).
struct Line {
  const keys::KeyEntry& entry;
  const Specimen& specimen;
  const Material& material;

  template <class Value>
  std::string of(const Value& value) const {
    std::ostringstream text;
    text << entry.key.name << " = ";
    if constexpr (std::is_same_v<Value, bool>) {
      text << (value ? "true" : "false");
    } else if constexpr (std::is_arithmetic_v<Value>) {
      if (!entry.range.contains(static_cast<double>(value))) return "";
      if constexpr (std::is_same_v<Value, double>) text << exact(value);
      if constexpr (std::is_same_v<Value, long>) text << value;
    } else {
      text << toml::value<std::string>(keys::text_of(value));
    }
    return text.str() + "\n";
  }
  template <class Value>
  std::string operator()(Value Material::*member) const {
    return of(material.*member);
  }
  template <class Value>
  std::string operator()(Value ContactModel::*member) const {
    return of(specimen.contact.*member);
  }
  template <class Value>
  std::string operator()(Value Damping::*member) const {
    return of(specimen.damping.*member);
  }
  template <class Value>
  std::string operator()(Value SolverOptions::*member) const {
    return of(specimen.solver.*member);
  }
  std::string operator()(keys::FrictionAngle) const { return ""; }  // said by friction
};

std::string table_text(const Specimen& specimen, const Material& material, const std::string& table) {
  std::string text;
  for (const auto& entry : keys::key_entries()) {
    if (entry.key.table == table && in_use(specimen, entry.key.name)) {
      text += std::visit(Line{entry, specimen, material}, entry.target);
    }
  }
  return text;
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
