// Enumerations by their names, as TOML writes them; the same names as in files.
#pragma once

#include "rvelab/specimen/field_layout.hpp"

namespace rvelab::keys {

using fields::from_text;
using fields::text_of;
using fields::Textual;

}  // namespace rvelab::keys
