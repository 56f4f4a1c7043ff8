// The parameters of a specimen as the TOML file that read_material_file reads, from the same table of keys.
#pragma once

#include <string>

#include "rvelab/specimen/specimen.hpp"

namespace rvelab::io {

/// The material file (read_material_file) with all parameters of the specimen.
std::string material_file_text(const Specimen& specimen);

}  // namespace rvelab::io
