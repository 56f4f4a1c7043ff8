// The tables [contact], [damping], [solver] and [[material]] of a TOML file, and assignments "table.key=value" of the
// command line, into the fields of a specimen. Reader, messages and documentation live from one table of keys
// (material_keys.cpp): key with its unit, default, range, meaning.
#pragma once

#include <toml++/toml.h>
#include <string>
#include <vector>

#include "rvelab/solver/specimen.hpp"

namespace rvelab {

/// A key that a file or the command line may set, and what there is to say about it.
struct Key {
  std::string table;    ///< "contact", "damping", "solver", "material", or a table of a protocol
  std::string name;     ///< ends in its unit, for example "young_modulus_Pa"
  std::string unit;     ///< "1" for a pure number, "-" for words and truth values
  std::string type;     ///< "number", "whole number", "truth", "word", "text", "list of numbers"
  std::string initial;  ///< default, as TOML writes it, or in words; "" if the key has none of its own
  std::string range;    ///< allowed values in words
  std::string meaning;
  bool required = false;  ///< the file must have it
  std::string dotted() const { return table + "." + name; }
  std::string allowed() const;  ///< range with its unit
};

/// A mistake in a file and the line that it stands in (0: unknown), or in an assignment of the command line.
struct KeyError {
  long line;
  std::string message;
  bool assigned = false;  ///< from the command line; the message names it
};

/// A mistake at a key or a value of a file, or of an assignment.
KeyError key_error(const toml::source_region& place, const std::string& message);

/// Where a key was set last: a value that an assignment put over that of the file stands under the file's key.
const toml::source_region& place_of(const toml::key& key, const toml::node& value);

/// What stands before the text of an assignment in messages, and marks the source of its nodes.
inline constexpr const char* assignment_prefix = "--set ";

/// The value of an assignment under the key "value": TOML, or a word where it is none. Its nodes know the assignment.
toml::table parsed_value(const std::string& text, const std::string& assignment);

/// The value of a node that is_number(): a whole number that no double holds (beyond 2^53) is rounded.
double number_in(const toml::node& node);

/// All keys, in the order of the tables.
const std::vector<Key>& known_keys();

/// The candidate with the smallest edit distance to `word` (what the word lacks at its end, such as a unit, counts
/// little); the first of several; "" if there are no candidates.
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

/// The known dotted key nearest to this one. A material's name ("material.sand.frictoin") is kept.
std::string nearest_key(const std::string& dotted_key);

/// Sets one field. `dotted_key`: "contact.slip"; "material.friction" for all materials, "material.NAME.friction" for
/// one. Integers are accepted for floats, numbers must be finite. Throws InputError naming key, value, range and, for
/// an unknown key, the nearest known one; the specimen is then as it was.
void set_key(Specimen& specimen, const std::string& dotted_key, const toml::node& value);

/// The same from an assignment as in --set: "contact.slip=full_radius_ratcheting". The value is TOML; what is not is
/// taken as a string, so that words need no quotation marks.
void set_key(Specimen& specimen, const std::string& assignment);

/// All assignments in order. Throws InputError with every mistake, one line each, when the others have been made.
void set_keys(Specimen& specimen, const std::vector<std::string>& assignments);

/// Reads one table. Every mistake is added to `errors` with its line and the reading goes on. For "material" the keys
/// act on all materials, and tables in it ([material.NAME]) on the named one. Read "contact" before "material": the
/// law says which unit a normal stiffness has.
void read_table(Specimen& specimen, const std::string& name, const toml::table& table, std::vector<KeyError>& errors);

/// Replaces the materials by those of a list [[material]]; names must differ. Mistakes as in read_table.
void read_materials(Specimen& specimen, const toml::array& list, std::vector<KeyError>& errors);

/// Throws InputError with all mistakes in the order of their lines, one line of text each: "path:line: message"; those
/// of the command line come last. Does nothing if there are none.
void raise(const std::string& path, std::vector<KeyError> errors);

/// Parses a TOML file. InputError naming file, line and column if it is missing or not TOML.
toml::table parse_toml_file(const std::string& path);

/// Reads what there is of [[material]] (or one [material]), [contact], [damping] and [solver] in a file; what else it
/// holds is the caller's. Mistakes as in read_table.
void read_material_tables(const toml::table& file, Specimen& specimen, std::vector<KeyError>& errors);

/// Reads a material file: [[material]] (or one [material]), [contact], [damping], [solver], and nothing else.
void read_material_file(const std::string& path, Specimen& specimen);

}  // namespace rvelab
