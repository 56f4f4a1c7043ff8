#include "rvelab/keys/material_toml.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "rvelab/error.hpp"
#include "rvelab/keys/edit_distance.hpp"
#include "rvelab/keys/key.hpp"
#include "rvelab/keys/shortened.hpp"
#include "rvelab/keys/table_reader.hpp"
#include "rvelab/specimen/field_layout.hpp"

namespace rvelab::keys {
namespace {

const std::vector<std::string> table_names{"contact", "damping", "solver", "material"};

template <class Value>
void convert(const std::string& dotted, const toml::node& value, const KeyEntry& entry, Value& field) {
  const std::string wrong = wrong_with(value, entry.key);
  if (!wrong.empty()) throw InputError(dotted + " = " + written(value) + " " + wrong);
  if constexpr (std::is_same_v<Value, bool>) {
    field = value.as_boolean()->get();
  } else if constexpr (std::is_same_v<Value, long>) {
    field = value.as_integer()->get();
  } else if constexpr (std::is_same_v<Value, double>) {
    constexpr double degree = 3.14159265358979323846 / 180;
    field = entry.as_tangent ? std::tan(number_in(value) * degree) : number_in(value);
  } else {
    fields::from_text(value.as_string()->get(), field);
  }
}

/// The key must be that of its field which the law, or the dashpot, reads.
void expect_unit(const Specimen& specimen, const std::string& dotted, const KeyEntry& entry) {
  const std::string instead = key_in_use(specimen, entry.key.name);
  if (instead.empty() || instead == entry.key.name) return;
  const bool of_law = entry.key.table == "material";
  throw InputError(dotted + " does not go with " +
                   (of_law ? "contact.law = " + fields::text_of(specimen.contact.law)
                           : "damping.dashpot = " + fields::text_of(specimen.damping.dashpot)) +
                   "; allowed: " + instead + "; use that key");
}

bool is_from_command_line(const toml::node& value) { return key_error(value.source(), "").assigned; }

/// What is wrong with a key of a material that the law of all contacts does not read; "" if nothing is.
std::string not_read(const Law law, const std::string& dotted) {
  const std::string key = dotted.substr(dotted.rfind('.') + 1), laws = laws_that_read(key);
  Specimen any;
  any.contact.law = law;
  if (!dotted.starts_with("material.") || laws.empty() || !key_in_use(any, key).empty()) return "";
  return dotted + " does not go with contact.law = " + name(law) + ", which does not read it; allowed: with " + laws +
         "; remove the key, or set contact.law";
}

/// Of one table, and those in it.
void expect_keys_of_law(const std::string& name, const toml::table& table, Law law, bool only_assigned,
                        std::vector<KeyError>& errors) {
  for (const auto& [key, value] : table) {
    const std::string dotted = name + "." + std::string(key.str());
    if (const toml::table* inner = value.as_table()) expect_keys_of_law(dotted, *inner, law, only_assigned, errors);
    if (only_assigned && !is_from_command_line(value)) continue;
    if (value.value<double>() == 0.0) continue;  // says nothing; a text with the keys of all laws has such
    if (const std::string wrong = not_read(law, dotted); !wrong.empty())
      errors.push_back(key_error(place_of(key, value), wrong));
  }
}

/// "material.sand.friction" into {"material.friction", "sand"}; other keys have no middle.
std::pair<std::string, std::string> without_material_name(const std::string& dotted) {
  const auto first = dotted.find('.'), last = dotted.rfind('.');
  if (first == last || dotted.compare(0, first, "material") != 0) return {dotted, ""};
  return {dotted.substr(0, first) + dotted.substr(last), dotted.substr(first + 1, last - first - 1)};
}

const KeyEntry* find_entry(const std::string& dotted) {
  const auto& entries = key_entries();
  const auto found =
      std::find_if(entries.begin(), entries.end(), [&](const KeyEntry& entry) { return entry.key.dotted() == dotted; });
  return found == entries.end() ? nullptr : &*found;
}

std::vector<Material*> materials_named(Specimen& specimen, const std::string& dotted, const std::string& material) {
  std::vector<Material*> found;
  Choices known;
  for (auto& each : specimen.materials) {
    if (material.empty() || each.name == material) found.push_back(&each);
    known.push_back(each.name);
  }
  if (found.empty()) {
    throw InputError(dotted + ": no material " + (material.empty() ? "is" : "\"" + material + "\" is") +
                     " in the specimen; allowed: " +
                     (known.empty() ? "none, since it has no materials" : listed(known)) + "; name one of them");
  }
  return found;
}

/// Throws if the key is a known one in another unit.
void refuse_other_unit(const std::string& dotted_key, const std::string& dotted, const std::string& material) {
  const auto dot = dotted.find('.');
  std::vector<Key> keys = known_keys();
  if (dot != std::string::npos) {
    std::erase_if(keys, [&](const Key& key) { return key.table != dotted.substr(0, dot); });
  }
  const auto answer = in_another_unit(dotted.substr(dot + 1), keys);  // npos + 1 = 0: no table is named
  if (!answer) return;
  const std::string table = answer->key.table + (material.empty() ? "" : "." + material);
  throw InputError(dotted_key + " is not known; write " + table + "." + answer->key.name + ", " + answer->factor);
}

/// One material from its defaults.
Material read_material(const Specimen& specimen, const toml::table& table, std::vector<KeyError>& errors) {
  Specimen one;
  one.contact = specimen.contact;
  one.materials.resize(1);
  read_table(one, "material", table, errors);
  return one.materials[0];
}

/// Replaces the materials by those of a list [[material]]; names must differ. Mistakes as in read_table.
void read_materials(Specimen& specimen, const toml::array& list, std::vector<KeyError>& errors) {
  std::vector<Material> materials;
  std::set<std::string> names;
  for (const auto& item : list) {
    const auto line = long(item.source().begin.line);
    if (!item.is_table()) {
      errors.push_back({line, "material holds " + written(item) + "; allowed: tables; write [[material]] above each"});
      continue;
    }
    materials.push_back(read_material(specimen, *item.as_table(), errors));
    if (!names.insert(materials.back().name).second) {
      errors.push_back({line, "material.name = \"" + materials.back().name +
                                  "\" is there twice; allowed: a name of its own for each; rename one"});
    }
  }
  specimen.materials = materials;
}

/// The known dotted key that was meant; "" where none is near. A material's name ("material.sand.frictoin") is kept.
std::string near_key(const std::string& dotted_key) {
  const auto [dotted, material] = without_material_name(dotted_key);
  const auto point = dotted.find('.');
  const std::string table = dotted.substr(0, point), name = dotted.substr(point == std::string::npos ? 0 : point + 1);
  std::vector<std::string> own, all;
  for (const Key& key : known_keys()) {
    all.push_back(key.name);
    if (key.table == table) own.push_back(key.name);
  }
  // A name that is one letter off in another table is meant, where the table itself has nothing as near.
  constexpr std::size_t letter = 4;
  std::string found = near_one(name, own), of_table = table;
  const std::string elsewhere = nearest(name, all);
  const bool one_letter_off = !elsewhere.empty() && edit_distance(name, elsewhere) <= letter;
  if (one_letter_off && (found.empty() || edit_distance(name, found) > 2 * letter)) {
    found = elsewhere;
    of_table = known_keys()[std::size_t(std::find(all.begin(), all.end(), found) - all.begin())].table;
  } else if (found.empty()) {
    // The table may be the misspelt part, or none was given.
    std::vector<std::string> whole;
    for (const Key& key : known_keys()) whole.push_back(key.dotted());
    return own.empty() ? near_one(dotted, whole) : "";
  }
  return of_table + (!material.empty() && of_table == "material" ? "." + material : "") + "." + found;
}

}  // namespace

std::string laws_that_read(const std::string& name) {
  return names_where<Law>([&](Law law) {
    return std::any_of(law_parameters().begin(), law_parameters().end(),
                       [&](const LawParameter& each) { return each.law == law && each.parameter.key == name; });
  });
}

std::string key_in_use(const Specimen& specimen, const std::string& name) {
  for (const LawParameter& asked : law_parameters())
    for (const LawParameter& read : law_parameters())
      if (name == asked.parameter.key && read.law == specimen.contact.law && read.value == asked.value)
        return read.parameter.key;
  const char *const of_coefficient = "normal_coefficient_N_s_m", *const viscoelastic = "viscoelastic_1_m_s";
  if (name != of_coefficient && name != viscoelastic) return "";
  const Dashpot dashpot = specimen.damping.dashpot;
  return dashpot == Dashpot::viscoelastic ? viscoelastic : dashpot == Dashpot::coefficient ? of_coefficient : "";
}

const std::vector<Key>& known_keys() {
  static const std::vector<Key> keys = [] {
    std::vector<Key> list;
    for (const auto& entry : key_entries()) list.push_back(entry.key);
    return list;
  }();
  return keys;
}

void set_key(Specimen& specimen, const std::string& dotted_key, const toml::node& value) {
  const auto [dotted, material] = without_material_name(dotted_key);
  const KeyEntry* entry = find_entry(dotted);
  if (entry == nullptr) {
    refuse_other_unit(dotted_key, dotted, material);
    const std::string near = near_key(dotted_key);
    throw InputError(
        "unknown key " + shortened(dotted_key) +
        (near.empty() ? "; no known key is near; rvelab keys lists them" : "; the nearest known key is " + near) +
        "; correct the name or remove it");
  }
  expect_unit(specimen, dotted_key, *entry);
  Material none;
  std::vector<Material*> materials{&none};
  if (entry->key.table == "material") materials = materials_named(specimen, dotted_key, material);
  for (Material* each : materials)
    with_field(*entry, specimen, *each, [&](auto& field) { convert(dotted_key, value, *entry, field); });
}

std::string unusual_in(const std::string& dotted_key, const toml::node& value) {
  const KeyEntry* entry = find_entry(without_material_name(dotted_key).first);
  if (entry == nullptr || !value.is_number()) return "";
  const std::string unusual = unusual_in(entry->key, number_in(value));
  return unusual.empty() ? "" : dotted_key + " = " + written(value) + " " + unusual;
}

std::vector<std::string> unusual_materials(const ContactModel& model, const std::vector<Material>& materials) {
  Specimen any;
  any.contact = model;
  std::vector<std::string> found;
  for (const KeyEntry& entry : key_entries()) {
    const Key& key = entry.key;
    const bool of_other_law = !laws_that_read(key.name).empty() && key_in_use(any, key.name) != key.name;
    if (key.table != "material" || entry.as_tangent || of_other_law) continue;
    for (const Material& material : materials) {
      std::string unusual;
      with_field(entry, any, material, [&](const auto& field) {
        if constexpr (std::is_same_v<std::decay_t<decltype(field)>, double>) {
          if (std::string why = unusual_in(key, field); !why.empty())
            unusual = key.table + "." + material.name + "." + key.name + " = " + as_toml(field) + " " + why;
        }
      });
      if (unusual.empty()) continue;
      found.push_back(unusual);
      break;
    }
  }
  return found;
}

void set_key(Specimen& specimen, const std::string& assignment) {
  const auto equals = assignment.find('=');
  if (equals == std::string::npos) {
    throw InputError("--set " + assignment +
                     " has no value; allowed: key=value; write for example contact.slip=consistent");
  }
  const std::string key = trimmed(assignment.substr(0, equals)), text = trimmed(assignment.substr(equals + 1));
  set_key(specimen, key, *parsed_value(text, assignment).get("value"));
}

void set_keys(Specimen& specimen, const std::vector<std::string>& assignments) {
  std::string mistakes;
  const auto add = [&](const std::string& mistake) { mistakes += (mistakes.empty() ? "" : "\n") + mistake; };
  for (const auto& assignment : assignments) {
    try {
      set_key(specimen, assignment);
    } catch (const InputError& error) {
      add(error.what());
    }
  }
  for (const auto& assignment : assignments)
    if (const auto wrong = not_read(specimen.contact.law, trimmed(assignment.substr(0, assignment.find('='))));
        !wrong.empty())
      add(wrong);
  if (!mistakes.empty()) throw InputError(mistakes);
}

void read_table(Specimen& specimen, const std::string& name, const toml::table& table, std::vector<KeyError>& errors) {
  if (table.contains("friction") && table.contains("friction_angle_deg")) {
    errors.push_back(key_error(table.get("friction_angle_deg")->source(),
                               name + ".friction and " + name +
                                   ".friction_angle_deg are both given; allowed: one of the two; remove the other"));
  }
  for (const auto& [key, value] : table) {
    const std::string dotted = name + "." + std::string(key.str());
    if (name == "material" && value.is_table()) {
      read_table(specimen, dotted, *value.as_table(), errors);
      continue;
    }
    try {
      set_key(specimen, dotted, value);
      if (std::string unusual = unusual_in(dotted, value); !unusual.empty()) {
        errors.push_back(key_error(place_of(key, value), unusual));
        errors.back().doubt = true;
      }
    } catch (const InputError& error) {
      errors.push_back(key_error(place_of(key, value), error.what()));
    }
  }
}

void read_material_tables(const toml::table& file, Specimen& specimen, std::vector<KeyError>& errors) {
  for (const auto& name : table_names) {  // [contact] first: see read_table
    const toml::node* node = file.get(name);
    if (node == nullptr) continue;
    if (name == "material" && node->is_array()) {
      read_materials(specimen, *node->as_array(), errors);
    } else if (name == "material" && node->is_table()) {
      specimen.materials = {read_material(specimen, *node->as_table(), errors)};
    } else if (node->is_table()) {
      read_table(specimen, name, *node->as_table(), errors);
    }
  }
  expect_keys_of_law(file, specimen, errors);
}

void expect_keys_of_law(const toml::table& file, const Specimen& specimen, std::vector<KeyError>& errors) {
  const toml::node* law = file["contact"]["law"].node();
  const bool only_assigned = law != nullptr && is_from_command_line(*law);
  const auto expect = [&](const toml::node& node) {
    if (const toml::table* table = node.as_table())
      expect_keys_of_law("material", *table, specimen.contact.law, only_assigned, errors);
  };
  const toml::node* materials = file.get("material");
  if (materials == nullptr) return;
  expect(*materials);
  if (const toml::array* list = materials->as_array()) std::for_each(list->begin(), list->end(), expect);
}

void expect_material_tables(const toml::table& file, std::vector<KeyError>& errors) {
  for (const auto& [key, value] : file) {
    const std::string name(key.str());
    const auto line = long(key.source().begin.line);
    if (std::find(table_names.begin(), table_names.end(), name) == table_names.end()) {
      errors.push_back({line, "unknown table [" + shortened(name) + "]; the nearest known one is [" +
                                  nearest(name, table_names) + "]; correct the name or remove it"});
    } else if (!value.is_table() && !(name == "material" && value.is_array())) {
      errors.push_back({line, name + " = " + written(value) + " is not a table; allowed: [" + name +
                                  "] with its keys below; write it so"});
    }
  }
}

void read_material_file(const std::string& path, Specimen& specimen) {
  const toml::table file = parse_toml_file(path);
  std::vector<KeyError> errors;
  expect_material_tables(file, errors);
  read_material_tables(file, specimen, errors);
  raise(path, errors);
}

}  // namespace rvelab::keys
