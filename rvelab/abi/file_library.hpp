// Files by way of librvelab-h5.so, which is loaded at the first call for one: found beside the library that this code
// is in, then as the loader finds it. Throws pool::Refused: no_library, or what the file led to.
#pragma once

#include <string>

#include "rvelab/pool/pool.hpp"
#include "rvelab/specimen/specimen.hpp"

namespace rvelab::abi {

/// The specimen of a specimen file, or the end state of a record file.
Specimen read_specimen(const std::string& path);

void write_pool(pool::Pool& pool, const std::string& path);
void read_pool(pool::Pool& pool, const std::string& path);

}  // namespace rvelab::abi
