// Assignments of the command line, put into a parsed protocol or recipe before it is checked.
#pragma once

#include <string>
#include <vector>

#include "rvelab/keys/key.hpp"

namespace rvelab::keys {

/// Applies one assignment to a parsed file. InputError if it has no value, or names no stage that is there.
void assign(toml::table& file, const std::string& assignment);

/// Applies the assignments of the command line; a wrong one becomes an error, the others are applied.
void assign_all(toml::table& file, const std::vector<std::string>& assignments, std::vector<KeyError>& errors);

}  // namespace rvelab::keys
