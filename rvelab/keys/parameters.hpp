// The parameters of a specimen as one text of TOML: what a material file holds, what a host reads and sets.
#pragma once

#include <string>

#include "rvelab/specimen/specimen.hpp"

namespace rvelab::keys {

/// [contact], [damping], [solver] and a [[material]] for each, with every key that the law reads, exact: what
/// read_material_file reads and set_parameters takes.
std::string parameters_text(const Specimen& specimen);

/// Sets the keys that the text has, in those tables or with dots ("material.sand.friction = 0.5"); all others stay.
/// [material] is for all materials, [material.NAME] and a [[material]] with that name for one. What the state keeps of
/// the parameters before goes (fit_state_to_parameters). InputError with every mistake, its line, key, value and range:
/// the specimen is then as it was.
void set_parameters(Specimen& specimen, const std::string& text);

}  // namespace rvelab::keys
