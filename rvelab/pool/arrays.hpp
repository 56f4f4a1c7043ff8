// What a host reads of a state by name: measures of the cell by the names that records have, columns of grains and
// contacts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "rvelab/pool/pool.hpp"

namespace rvelab::pool {

/// An array without the state that it is of.
struct ArrayText {
  const char *name, *unit, *meaning;
  std::int32_t of, type;  ///< RVELAB_OF_..., RVELAB_DOUBLE or RVELAB_INT64
  std::int64_t columns;
};

/// All arrays of any state, the same in every process of one build.
std::span<const ArrayText> array_texts();

/// Rows of each of them in this state; -1: a state of this shape has none.
std::vector<std::int64_t> array_rows(const Rve& rve);

/// The k-th of them, row after row, 8 bytes an entry. The state must have it.
std::vector<std::byte> array_of(const Rve& rve, std::size_t k);

}  // namespace rvelab::pool
