// The gather table (scene.hpp, GrainArrays): which force rows each grain adds up, laid out for loops of equal length.
#pragma once

#include "rvelab/solver/assembly.hpp"

namespace rvelab {

/// Fills slot_begin, slots and tasks of the table for its listed pairs, in their order; `force_row` doubles a row.
void fill_gather_table(std::size_t padded_grains, std::int32_t force_row, PairTable& pairs);

}  // namespace rvelab
