// Grains sorted into linked cells, by size: what the neighbour list is searched in.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "rvelab/cell/cell.hpp"

namespace rvelab {

/// A grain as the search sees it: position wrapped into the cell, lattice translation that took it there, bin by bin.
struct Binned {
  double x[3], radius;
  std::int32_t grain;
  Image period;  ///< position = x + L period
};

/// The grains of one size class, sorted into bins along the lattice directions.
struct SizeClass {
  double largest_radius = 0;
  int count[3] = {1, 1, 1};
  std::vector<std::int32_t> begin;  ///< first of each bin in `grains`
  std::vector<Binned> grains;       ///< bin by bin, indices ascending within a bin

  std::size_t index(int a, int b, int c) const { return (std::size_t(c) * count[1] + b) * count[0] + a; }
};

/// Place of a grain in units of the lattice vectors, 0 <= s < 1, and its binned form.
struct Placed {
  double s[3];
  Binned binned;
};

/// A grain at `at` (m, cell frame, anywhere in space), wrapped into the cell.
Placed placed(const Cell& cell, const double* at, double radius, std::size_t grain);

inline int bin_of(double s, int count) { return std::min(count - 1, int(s * count)); }

/// Size classes by halves of the largest radius, so that no grain is looked for in bins much wider than itself:
/// gradings of 1:50 stay O(N). Eight classes, some of them empty; the last holds all that is smaller.
std::vector<SizeClass> sort_into_bins(const Cell& cell, const std::vector<Placed>& grains,
                                      const std::vector<double>& radii, double skin);

}  // namespace rvelab
