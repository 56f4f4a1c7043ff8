// The tables [contact], [damping], [solver] and [[material]] of a TOML file, and assignments "table.key=value" of the
// command line, into the fields of a specimen. Reader, messages and documentation live from one table of keys
// (material_keys.cpp): key with its unit, default, range, meaning.
#pragma once

#include <toml++/toml.h>
#include <string>
#include <variant>
#include <vector>

#include "rvelab/contact/model.hpp"
#include "rvelab/keys/key.hpp"
#include "rvelab/specimen/specimen.hpp"

namespace rvelab::keys {

/// All keys, in the order of the tables.
const std::vector<Key>& known_keys();

/// Sets one field. `dotted_key`: "contact.slip"; "material.friction" for all materials, "material.NAME.friction" for
/// one. Integers are accepted for floats, numbers must be finite. Throws InputError naming key, value, range and, for
/// an unknown key, the nearest known one; the specimen is then as it was.
void set_key(Specimen& specimen, const std::string& dotted_key, const toml::node& value);

/// What is unusual in a value that set_key takes, "material.sand.friction = 27 is unusual; ..."; "" if nothing is.
std::string unusual_in(const std::string& dotted_key, const toml::node& value);

/// The unusual values among those that the contact law of a specimen reads of its materials, each key once.
std::vector<std::string> unusual_materials(const ContactModel& model, const std::vector<Material>& materials);

/// The same from an assignment as in --set: "contact.slip=full_radius_ratcheting". The value is TOML; what is not is
/// taken as a string, so that words need no quotation marks.
void set_key(Specimen& specimen, const std::string& assignment);

/// All assignments in order. Throws InputError with every mistake, one line each, when the others have been made; a key
/// that the law in the end does not read is one.
void set_keys(Specimen& specimen, const std::vector<std::string>& assignments);

/// Reads one table. Every mistake is added to `errors` with its line and the reading goes on. For "material" the keys
/// act on all materials, and tables in it ([material.NAME]) on the named one. Read "contact" before "material": the
/// law says which unit a normal stiffness has.
void read_table(Specimen& specimen, const std::string& name, const toml::table& table, std::vector<KeyError>& errors);

/// Reads what there is of [[material]] (or one [material]), [contact], [damping] and [solver] in a file, and expects
/// keys of the law; what else it holds is the caller's. Mistakes as in read_table.
void read_material_tables(const toml::table& file, Specimen& specimen, std::vector<KeyError>& errors);

/// The file holds these tables and nothing else. Mistakes as in read_table.
void expect_material_tables(const toml::table& file, std::vector<KeyError>& errors);

/// Each law's own key of a material, among those tables of a file, is one that the law of the specimen reads: they have
/// been read into it; a key that is 0 says nothing. If --set gave the law, only keys of --set are checked: the file was
/// written for another law. Mistakes as in read_table.
void expect_keys_of_law(const toml::table& file, const Specimen& specimen, std::vector<KeyError>& errors);

/// Reads a material file: [[material]] (or one [material]), [contact], [damping], [solver], and nothing else.
void read_material_file(const std::string& path, Specimen& specimen);

/// The field that a key sets.
using Target =
    std::variant<std::string Material::*, double Material::*, double Damping::*, bool Damping::*, Dashpot Damping::*,
                 LocalDampingForm Damping::*, double SolverOptions::*, long SolverOptions::*, bool SolverOptions::*,
                 bool ContactModel::*, Law ContactModel::*, Slip ContactModel::*, HertzRadius ContactModel::*>;

struct KeyEntry {
  Key key;
  Target target;
  bool as_tangent = false;  ///< an angle in degrees, of which the field holds the tangent
};

/// What `call` makes of the field that a key sets, of this material or of the rest of the specimen.
template <class AnySpecimen, class AnyMaterial, class Call>
auto with_field(const KeyEntry& entry, AnySpecimen& specimen, AnyMaterial& material, Call call) {
  return std::visit(
      [&]<class Value, class Owner>(Value Owner::*member) {
        if constexpr (std::is_same_v<Owner, Material>) return call(material.*member);
        if constexpr (std::is_same_v<Owner, Damping>) return call(specimen.damping.*member);
        if constexpr (std::is_same_v<Owner, SolverOptions>) return call(specimen.solver.*member);
        if constexpr (std::is_same_v<Owner, ContactModel>) return call(specimen.contact.*member);
      },
      entry.target);
}

/// The laws whose own key of a material this is, "hertz_mindlin, cones"; "" if it is no law's own.
std::string laws_that_read(const std::string& name);

/// Keys may share a field and not its unit: the one of them that the law, or the dashpot, reads; "" if it reads none.
std::string key_in_use(const Specimen& specimen, const std::string& name);

const std::vector<KeyEntry>& key_entries();

}  // namespace rvelab::keys
