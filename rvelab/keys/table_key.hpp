// An entry of a table of keys: a key, its kind, and what its values may be. A reader takes these from the table
// (table_reader.hpp) and `rvelab keys` prints it, so that what is read, what is refused and what is documented cannot
// differ.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "rvelab/contact/model.hpp"
#include "rvelab/keys/key.hpp"

namespace rvelab::keys {

enum class KeyKind {
  number,
  whole_number,
  boolean,
  text,
  choice,  ///< one of some names
  numbers,
  choices,     ///< a list of them
  components,  ///< a table of components of a tensor: {xx = 1, xy = 0.5}
  matrices,    ///< a list of lists of numbers
  tables       ///< [[...]] with keys of their own
};

struct TableKey {
  Key key;
  KeyKind kind;
  Interval range;                                                         ///< numbers, each of a list too
  std::vector<std::string> choices;                                       ///< of choice and choices
  std::variant<std::monostate, double, long, bool, std::string> initial;  ///< none: required, optional, or computed
};

}  // namespace rvelab::keys
