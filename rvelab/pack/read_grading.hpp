// The grading of a fraction of grains, from its keys.
#pragma once

#include "rvelab/grains/grading.hpp"
#include "rvelab/keys/table_reader.hpp"

namespace rvelab::pack {

/// Reads grains.grading and the keys that go with it; mistakes go to the reader.
void read_grading(keys::TableReader& reader, Grading& grading);

}  // namespace rvelab::pack
