// How long a neighbour list may become, said before it is made: radii in millimetres for metres put a thousand images
// of every grain within reach of every other, and memory is gone before anything else could fail.
#pragma once

#include <cstddef>
#include <vector>

#include "rvelab/cell/cell.hpp"

namespace rvelab {

/// Pairs that a list may have: 1000 a grain, 100,000 in a small assembly, 10^9 in all. Packings list 3 (2D) to 10 (3D)
/// a grain; a pair takes some 300 bytes.
double allowed_pairs(std::size_t grains);

/// Bins that a search may look into, all grains together.
double allowed_looks(std::size_t grains);

/// No fewer pairs than grains of these radii (m) with this skin (m) can have, wherever they lie. Of one pair this is
/// what lies in a ball of its reach R, by volume, surface and width of the ball over those of the cell:
///   4/3 pi R^3/V + pi R^2 (1/(ab) + 1/(bc) + 1/(ac)) + 2R (1/a + 1/b + 1/c) + 1,  V = abc
/// with a, b, c the diagonal of the lattice: its points lie in planes c apart, there in rows b apart, there a apart,
/// and a sum over equidistant points of what rises and then falls is at most its integral and its largest value. In
/// the plane pi R^2/V + 2R (1/a + 1/b) + 1. Near the truth where grains reach through the cell, N^2/2 where they do
/// not. O(N).
double pairs_by_volume(const Cell& cell, const std::vector<double>& radii, double skin);

/// Throws IncrementFailed if volume or heights of the cell are zero or infinite as numbers.
void expect_computable(const Cell& cell);

/// Throws IncrementFailed, which says how many pairs (or bins, in a cell that is skew) there would be, and what may be
/// wrong.
[[noreturn]] void refuse_pairs(double pairs, const Cell& cell, const std::vector<double>& radii, double skin);
[[noreturn]] void refuse_looks(double looks, const Cell& cell);

}  // namespace rvelab
