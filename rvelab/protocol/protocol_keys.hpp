// The table of keys of a protocol. The reader takes kind, default and range of every key from here and `rvelab keys`
// prints it, so that what is read, what is refused and what is documented cannot differ: a key that is read without an
// entry, or an entry that its table's reader does not ask for, is a std::logic_error at the first reading.
//
// A new key: one entry here, one call in the reader of its table, one row in protocols/README.md (a test compares
// them).
#pragma once

#include <string>
#include <vector>

#include "rvelab/keys/table_key.hpp"

namespace rvelab::protocol {

/// Every key that a protocol or a recipe may have, in the order of its tables: those of the protocol itself ("test",
/// "loading", "stage", "stage.compression", ...), those of a recipe ("pack", "grains", "target", "preparation"), then
/// those of a material file (contact, damping, solver, material).
const std::vector<keys::Key>& all_keys();

using keys::TableKey;

const std::vector<TableKey>& protocol_keys();

/// Tables that a protocol may have at its top level.
const std::vector<std::string>& top_tables();

}  // namespace rvelab::protocol
