// Regular packings: equal grains in rows, each row shifted by half a grain against the one below. Discs make the
// triangular lattice, ellipses (and what else fills such rows) that lattice stretched along their long axes. All long
// axes lie along the rows, and the rows, with the cell, at the bedding angle: so every angle fits the periodic cell.
#pragma once

#include "rvelab/pack/recipe.hpp"

namespace rvelab::pack {

/// Numbers of grains: in a row, and of rows (even, so that the cell is upright in its frame).
struct RowCounts {
  std::size_t in_row = 0, rows = 0;
};

/// Of all rows that `number` grains make, those whose cell is nearest to a square; 0, 0: they make none.
RowCounts row_counts(std::size_t number, double aspect_ratio);

/// Throws InputError for a recipe of this preparation that rows cannot be made of.
void check_regular(const Recipe& recipe);

/// Places the graded grains in rows that just touch; their cell. The grains' axes lie along x of the cell's frame.
Cell lay_rows(const Recipe& recipe, Grains& grains);

}  // namespace rvelab::pack
