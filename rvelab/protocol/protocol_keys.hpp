// The table of keys of a protocol. The reader takes kind, default and range of every key from here and `rvelab keys`
// prints it, so that what is read, what is refused and what is documented cannot differ: a key that is read without an
// entry, or an entry that its table's reader does not ask for, is a std::logic_error at the first reading.
//
// A new key: one entry here, one call in the reader of its table, one row in README.md (a test compares them).
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "rvelab/io/material_keys.hpp"

namespace rvelab {

/// Every key that a protocol or a recipe may have, in the order of its tables: those of the protocol itself ("test",
/// "loading", "stage", "stage.compression", ...), those of a recipe ("pack", "grains", "target", "preparation"), then
/// those of rvelab/io (contact, damping, solver, material).
const std::vector<Key>& all_keys();

namespace protocol {

enum class KeyKind {
  number,
  whole_number,
  truth,
  text,
  word,
  numbers,
  words,       ///< a list of words
  components,  ///< a table of components of a tensor: {xx = 1, xy = 0.5}
  matrices,    ///< a list of lists of numbers
  tables       ///< [[...]] with keys of their own
};

struct ProtocolKey {
  Key key;
  KeyKind kind;
  io::Range range;                                                        ///< numbers, each of a list too
  std::vector<std::string> words;                                         ///< of word and words
  std::variant<std::monostate, double, long, bool, std::string> initial;  ///< none: required, optional, or computed
};

const std::vector<ProtocolKey>& protocol_keys();

/// The keys of recipes, beside which contact, damping, solver and material stand (recipe_keys.cpp).
const std::vector<ProtocolKey>& recipe_keys();

/// The entry of a key. std::logic_error if there is none.
const ProtocolKey& protocol_key(const std::string& table, const std::string& name);

/// Tables that a protocol may have at its top level.
const std::vector<std::string>& top_tables();

}  // namespace protocol
}  // namespace rvelab
