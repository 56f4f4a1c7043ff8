#include "rvelab/solver/neighbour_list.hpp"

#include <algorithm>
#include <cmath>

namespace rvelab {

bool points_forward(const Image& image) {
  for (int n : image)
    if (n != 0) return n > 0;
  return false;
}

namespace {

/// Bins along the lattice directions: how many, how far the search reaches, and which grains each holds.
struct Bins {
  int count[3] = {1, 1, 1};
  int reach[3] = {0, 0, 0};
  std::vector<std::int32_t> begin;   ///< first entry of each bin in `grains`
  std::vector<std::int32_t> grains;  ///< grain indices bin by bin, ascending within a bin
  std::vector<Image> bin_of;         ///< bin coordinates of each grain
  std::vector<Image> period_of;      ///< period in which each grain lies: s = s0 + period, 0 <= s0 < 1

  std::size_t index(const Image& bin) const { return (std::size_t(bin[2]) * count[1] + bin[1]) * count[0] + bin[0]; }
};

Bins sort_into_bins(const Cell& cell, const double* x, std::size_t stride, std::size_t n, double cutoff) {
  Bins bins;
  const Vector3 height = heights(cell);
  const int d = cell.dimension;
  // Bins as wide as the cutoff, but never more than about one per grain: an almost empty cell needs no finer mesh.
  const int most = std::max(1, int(std::floor(d == 2 ? std::sqrt(double(n)) : std::cbrt(double(n)))) * 2);
  for (int k = 0; k < d; ++k) {
    bins.count[k] = int(std::clamp(std::floor(height[k] / cutoff), 1.0, double(most)));
    bins.reach[k] = int(std::ceil(cutoff * bins.count[k] / height[k] * (1 + 1e-12)));
  }
  const std::size_t total = std::size_t(bins.count[0]) * bins.count[1] * bins.count[2];
  bins.begin.assign(total + 1, 0);
  bins.bin_of.resize(n);
  bins.period_of.resize(n);
  const Matrix3& l = cell.lattice;
  for (std::size_t g = 0; g < n; ++g) {
    const double* at = x + stride * g;
    double s[3] = {0, 0, 0};
    if (d == 3) s[2] = at[2] / l(2, 2);
    s[1] = (at[1] - (d == 3 ? l(1, 2) * s[2] : 0)) / l(1, 1);
    s[0] = (at[0] - l(0, 1) * s[1] - (d == 3 ? l(0, 2) * s[2] : 0)) / l(0, 0);
    for (int k = 0; k < 3; ++k) {
      const double period = std::floor(s[k]);
      bins.period_of[g][k] = k < d ? int(period) : 0;
      bins.bin_of[g][k] = k < d ? std::min(bins.count[k] - 1, int((s[k] - period) * bins.count[k])) : 0;
    }
    ++bins.begin[bins.index(bins.bin_of[g]) + 1];
  }
  for (std::size_t b = 0; b < total; ++b) bins.begin[b + 1] += bins.begin[b];
  bins.grains.resize(n);
  std::vector<std::int32_t> next(bins.begin.begin(), bins.begin.end() - 1);
  for (std::size_t g = 0; g < n; ++g) bins.grains[next[bins.index(bins.bin_of[g])]++] = std::int32_t(g);
  return bins;
}

int floor_divide(int a, int b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

}  // namespace

std::vector<ListedPair> list_pairs(const Cell& cell, const double* x, std::size_t stride,
                                   const std::vector<double>& radii, double skin) {
  const std::size_t n = radii.size();
  std::vector<ListedPair> pairs;
  if (n == 0) return pairs;
  const int d = cell.dimension;
  const double cutoff = 2 * *std::max_element(radii.begin(), radii.end()) + skin;
  const Bins bins = sort_into_bins(cell, x, stride, n, cutoff);
  const Matrix3& l = cell.lattice;
  pairs.reserve(n * std::size_t(d == 2 ? 4 : 8));
  const int reach_z = d == 3 ? bins.reach[2] : 0;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t first = pairs.size();
    const double* xi = x + stride * i;
    Image offset, bin, shift{};
    for (offset[2] = -reach_z; offset[2] <= reach_z; ++offset[2])
      for (offset[1] = -bins.reach[1]; offset[1] <= bins.reach[1]; ++offset[1])
        for (offset[0] = -bins.reach[0]; offset[0] <= bins.reach[0]; ++offset[0]) {
          for (int k = 0; k < 3; ++k) {
            const int place = bins.bin_of[i][k] + offset[k];
            shift[k] = floor_divide(place, bins.count[k]);
            bin[k] = place - shift[k] * bins.count[k];
          }
          const std::size_t b = bins.index(bin);
          for (std::int32_t q = bins.begin[b]; q < bins.begin[b + 1]; ++q) {
            const std::int32_t j = bins.grains[q];
            if (j < std::int32_t(i)) continue;
            Image image;
            for (int k = 0; k < 3; ++k) image[k] = shift[k] - bins.period_of[j][k] + bins.period_of[i][k];
            if (j == std::int32_t(i) && !points_forward(image)) continue;
            const double* xj = x + stride * j;
            const double reach = radii[i] + radii[j] + skin;
            const double dx = xj[0] - xi[0] + l(0, 0) * image[0] + l(0, 1) * image[1] + l(0, 2) * image[2];
            const double dy = xj[1] - xi[1] + l(1, 1) * image[1] + l(1, 2) * image[2];
            const double dz = d == 3 ? xj[2] - xi[2] + l(2, 2) * image[2] : 0;
            if (dx * dx + dy * dy + dz * dz < reach * reach) pairs.push_back({std::int32_t(i), j, image});
          }
        }
    std::sort(pairs.begin() + first, pairs.end());
  }
  return pairs;
}

}  // namespace rvelab
