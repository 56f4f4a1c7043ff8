// The Verlet list: every pair of grains, images included, whose surfaces are closer than the skin.
//
// Built from linked cells in lattice coordinates. Where a cell height is below the reach of a pair, the search runs
// over several periods, so that several images of one pair, a grain's own included, are listed: correctness never
// rests on a compact cell. O(N) for a bounded ratio of radii.
#pragma once

#include <cstdint>
#include <tuple>
#include <vector>

#include "rvelab/cell/cell.hpp"
#include "rvelab/threads/pieces.hpp"

namespace rvelab {

/// A listed pair: branch x_j + L image - x_i. i < j, or i == j with the first non-zero of image positive.
struct ListedPair {
  std::int32_t i, j;
  Image image;
  friend bool operator==(const ListedPair&, const ListedPair&) = default;
  friend bool operator<(const ListedPair& a, const ListedPair& b) {
    return std::tie(a.i, a.j, a.image) < std::tie(b.i, b.j, b.image);
  }
};

/// All pairs with |branch| < r_i + r_j + skin, ordered by (i, j, image).
/// positions: x[stride * g + component], cell frame, m, anywhere within 2^30 cells; radii: m. The list is the same on
/// any team. Throws IncrementFailed, before a pair is made, if there may be more than list_size.hpp allows.
std::vector<ListedPair> list_pairs(const Cell& cell, const double* positions, std::size_t stride,
                                   const std::vector<double>& radii, double skin, Workers* team = nullptr);

/// No fewer pairs than list_pairs makes of the same, without making one.
double pairs_at_most(const Cell& cell, const double* positions, std::size_t stride, const std::vector<double>& radii,
                     double skin);

inline bool is_shifted(const Image& image) { return (image[0] | image[1] | image[2]) != 0; }

/// True if the first non-zero entry is positive: of a grain and its own image each pair is listed once.
bool points_forward(const Image& image);

}  // namespace rvelab
