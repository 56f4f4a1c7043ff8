// Keys of TOML files, and mistakes in keys and values, each with its line or its assignment of the command line.
#pragma once

#include <toml++/toml.h>

#include <optional>
#include <string>
#include <vector>

#include "rvelab/contact/parameter.hpp"

namespace rvelab::keys {

/// The values that a key usually has; 0, where it is allowed, is never unusual. One beyond them is allowed too, but
/// likely in another unit.
struct Usual {
  Interval values{-no_bound, no_bound};
  double again_from = no_bound;  ///< from here on a value is meant: friction of 1e6 stands for no slip
  constexpr bool holds(double value) const { return value == 0 || values.contains(value) || value >= again_from; }
  constexpr bool is_stated() const { return values.low > -no_bound || values.high < no_bound; }
};

/// What a number may be, and what it usually is.
struct Range : Interval {
  Usual usual{};
  constexpr Range(double low = 0, double high = 0, bool low_open = false, bool high_open = false)
      : Interval{low, high, low_open, high_open} {}
  constexpr Range(const Interval& allowed, const Usual& usually = {}) : Interval(allowed), usual(usually) {}
};

/// A key that a file or the command line may set.
struct Key {
  std::string table;    ///< "contact", "damping", "solver", "material", or a table of a protocol
  std::string name;     ///< ends in its unit, for example "young_modulus_Pa"
  std::string unit;     ///< "1" for a pure number, "-" for texts, choices and booleans
  std::string type;     ///< "number", "whole number", "boolean", "choice", "text", "list of numbers"
  std::string initial;  ///< default, as TOML writes it, or in words; "" if the key has none of its own
  std::string range;    ///< allowed values in words
  std::string meaning;
  Interval interval = {};                 ///< of numbers, each of a list too
  std::vector<std::string> choices = {};  ///< of a choice, or a list of them
  bool required = false;                  ///< the file must have it
  Usual usual = {};                       ///< of numbers
  std::string dotted() const { return table + "." + name; }
  std::string allowed() const;  ///< range with its unit
};

/// A mistake in a file and the line that it stands in (0: unknown), or in an assignment of the command line.
struct KeyError {
  long line;
  std::string message;
  bool assigned = false;  ///< from the command line; the message names it
  bool doubt = false;     ///< no mistake, but a value that is unusual: raise() passes it by
};

/// How many are mistakes.
std::size_t mistakes_in(const std::vector<KeyError>& errors);

/// The messages of the doubts among them, each key once. Without path and line: files of results hold them.
std::vector<std::string> doubts_in(const std::vector<KeyError>& errors);

/// The key that a doubt names, "material.friction" of "--set ...: material.friction = 27 is unusual"; the whole text if
/// it names none.
std::string key_of_doubt(const std::string& doubt);

/// Them as comments in front of a text of TOML.
std::string with_doubts(const std::vector<std::string>& doubts, const std::string& text);

/// "1000 to 1e+09 Pa, or from 100 on" of a key; "" if nothing is stated.
std::string usual_in_words(const Key& key);

/// What is unusual in a value that is allowed, with its likely unit: "is unusual; usual: 1000 to 1e+09 Pa; likely in
/// kPa: write 100000". "" if nothing is.
std::string unusual_in(const Key& key, double value);

/// "likely in MPa or GPa: write 7e+07 or 7e+10": the units in which a value that was given in `unit` is usual; without
/// any a word to check it.
std::string likely_unit(const std::string& unit, double value, const Usual& usual);

/// A mistake at a key or a value of a file, or of an assignment.
KeyError key_error(const toml::source_region& place, const std::string& message);

/// Where a key was set last: a value by an assignment has the key of the file and a source of its own.
const toml::source_region& place_of(const toml::key& key, const toml::node& value);

/// Begins an assignment in messages, and marks the source of its nodes.
inline constexpr const char* assignment_prefix = "--set ";

/// The value of an assignment under the key "value": TOML, or a word where it is none. Its nodes know the assignment.
toml::table parsed_value(const std::string& text, const std::string& assignment);

/// The value of a node that is_number(): a whole number that no double holds (beyond 2^53) is rounded.
double number_in(const toml::node& node);

/// The candidate with the smallest edit distance to `word` (what the word lacks at its end, such as a unit, counts
/// little); the first of several; "" if there are no candidates.
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

/// The candidate that was meant by `word`: the nearest one where less than half of the letters differ, or one that has
/// the word among its own ("tolerance": relative_tolerance); "" where none is near.
std::string near_one(const std::string& word, const std::vector<std::string>& candidates);

/// "; the nearest is biaxial", or "" where none is near.
std::string nearest_in_words(const std::string& word, const std::vector<std::string>& candidates);

/// Which of the known names was meant by `word`, and the remedy: one that is near; else all of them, or where they are
/// listed. Of a table of another kind of file, what that file is for.
std::string what_was_meant(const std::string& prefix, const std::string& word, const std::vector<std::string>& known);

/// Remedy for a word that is none of the choices: "the nearest is simple_shear; choose one of these", without the
/// nearest where none is near.
std::string choose_one(const std::string& word, const std::vector<std::string>& choices);

/// Throws InputError with all mistakes (not doubts) in the order of their lines, one line of text each: "path:line:
/// message"; those of the command line come last. Does nothing if there are none.
void raise(const std::string& path, std::vector<KeyError> errors);

/// Parses a TOML file, or a text whose messages name `path`. InputError naming file, line and column: missing, not
/// TOML.
toml::table parse_toml_file(const std::string& path);
toml::table parse_toml_text(const std::string& text, const std::string& path);

/// Applies the assignments of the command line to a parsed file; a wrong one, without a value or of a table that is not
/// there, becomes an error, the others are applied. A table of a list goes by its name (a stage without one: its kind)
/// or its number from 0. `least_names` before the =: 1 where whole tables may be assigned.
void assign_all(toml::table& file, const std::vector<std::string>& assignments, std::vector<KeyError>& errors,
                std::size_t least_names = 2);

/// The right key and how the two units go together: "pressure_Pa", "1 kPa = 1000 Pa".
struct UnitAnswer {
  Key key;
  std::string factor;
};

/// The known key that `name` (without its table) means in another unit; none if it is no known key with another unit.
std::optional<UnitAnswer> in_another_unit(const std::string& name, const std::vector<Key>& known);

}  // namespace rvelab::keys
