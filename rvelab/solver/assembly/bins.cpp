#include "rvelab/solver/assembly/bins.hpp"

#include <cmath>

namespace rvelab {

namespace {

int size_class(double radius, double largest) {
  int k = 0;
  for (double bound = 0.5 * largest; radius < bound && k < 7; bound *= 0.5) ++k;
  return k;
}

}  // namespace

Placed placed(const Cell& cell, const double* at, double radius, std::size_t grain) {
  const Matrix3& l = cell.lattice;
  const bool space = cell.dimension == 3;
  Placed p{};
  p.s[2] = space ? at[2] / l(2, 2) : 0;
  p.s[1] = (at[1] - (space ? l(1, 2) * p.s[2] : 0)) / l(1, 1);
  p.s[0] = (at[0] - l(0, 1) * p.s[1] - (space ? l(0, 2) * p.s[2] : 0)) / l(0, 0);
  for (int k = 0; k < cell.dimension; ++k) {
    const double period = std::floor(p.s[k]);
    p.s[k] -= period;
    p.binned.period[k] = int(period);
  }
  const Image& n = p.binned.period;
  p.binned.x[0] = at[0] - (l(0, 0) * n[0] + l(0, 1) * n[1] + l(0, 2) * n[2]);
  p.binned.x[1] = at[1] - (l(1, 1) * n[1] + l(1, 2) * n[2]);
  p.binned.x[2] = space ? at[2] - l(2, 2) * n[2] : 0;
  p.binned.radius = radius;
  p.binned.grain = std::int32_t(grain);
  return p;
}

std::vector<SizeClass> sort_into_bins(const Cell& cell, const std::vector<Placed>& grains,
                                      const std::vector<double>& radii, double skin) {
  const double largest = *std::max_element(radii.begin(), radii.end());
  std::vector<SizeClass> classes(8);
  std::vector<std::size_t> members(8, 0);
  for (const double r : radii) {
    const int k = size_class(r, largest);
    classes[k].largest_radius = std::max(classes[k].largest_radius, r);
    ++members[k];
  }
  const Vector3 height = heights(cell);
  const int d = cell.dimension;
  for (std::size_t k = 0; k < classes.size(); ++k) {
    SizeClass& c = classes[k];
    if (members[k] == 0) continue;
    // As wide as two of them, but no more bins than grains or so: an almost empty cell needs no finer mesh.
    const double width = 2 * c.largest_radius + skin, n = double(members[k]);
    const int most = std::max(1, int(std::floor(d == 2 ? std::sqrt(n) : std::cbrt(n))) * 2);
    // A third of that along the first direction, where bins follow each other in memory: a search looks into fewer
    // grains, and into no more rows of bins.
    for (int a = 0; a < d; ++a)
      c.count[a] = int(std::clamp(std::floor((a == 0 ? 3 : 1) * height[a] / width), 1.0, double(most)));
    c.begin.assign(std::size_t(c.count[0]) * c.count[1] * c.count[2] + 1, 0);
    c.grains.resize(members[k]);
  }
  const auto bin = [&](const Placed& p, const SizeClass& c) {
    return c.index(bin_of(p.s[0], c.count[0]), bin_of(p.s[1], c.count[1]), bin_of(p.s[2], c.count[2]));
  };
  for (const Placed& p : grains) {
    SizeClass& c = classes[size_class(p.binned.radius, largest)];
    ++c.begin[bin(p, c) + 1];
  }
  std::vector<std::vector<std::int32_t>> next(classes.size());
  for (std::size_t k = 0; k < classes.size(); ++k) {
    SizeClass& c = classes[k];
    for (std::size_t b = 1; b < c.begin.size(); ++b) c.begin[b] += c.begin[b - 1];
    next[k] = c.begin;
  }
  for (const Placed& p : grains) {
    const int k = size_class(p.binned.radius, largest);
    classes[k].grains[next[k][bin(p, classes[k])]++] = p.binned;
  }
  return classes;
}

}  // namespace rvelab
