#include "rvelab/solver/assembly/list_size.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "rvelab/error.hpp"

namespace rvelab {

namespace {

using std::numbers::pi;

/// Sums over all ordered pairs, a grain with itself too, of powers of the reach R = a_i + a_j.
struct ReachPowers {
  double one = 0, first = 0, second = 0, third = 0;
};

ReachPowers powers_of_reach(const std::vector<double>& radii, double skin) {
  double a1 = 0, a2 = 0, a3 = 0;
  for (const double radius : radii) {
    const double a = radius + 0.5 * skin;
    a1 += a;
    a2 += a * a;
    a3 += a * a * a;
  }
  const double n = double(radii.size());
  return {n * n, 2 * n * a1, 2 * (n * a2 + a1 * a1), 2 * n * a3 + 6 * a1 * a2};
}

std::string edges_in_words(const Cell& cell) {
  std::string text;
  for (int k = 0; k < cell.dimension; ++k) text += (k > 0 ? " x " : "") + in_words(cell.lattice.col(k).norm());
  return text;
}

}  // namespace

// Places of forces are 32-bit numbers, eight to a pair of spheres.
double allowed_pairs(std::size_t grains) { return std::min(2.6e8, std::max(1e5, 1e3 * double(grains))); }

double allowed_looks(std::size_t grains) { return std::max(1e7, 1e4 * double(grains)); }

double pairs_by_volume(const Cell& cell, const std::vector<double>& radii, double skin) {
  const ReachPowers reach = powers_of_reach(radii, skin);
  const double a = 1 / cell.lattice(0, 0), b = 1 / cell.lattice(1, 1), c = 1 / cell.lattice(2, 2);
  double in_reach;
  if (cell.dimension == 2)
    in_reach = pi * a * b * reach.second + 2 * (a + b) * reach.first + reach.one;
  else
    in_reach = 4 * pi / 3 * a * b * c * reach.third + pi * (a * b + b * c + a * c) * reach.second +
               2 * (a + b + c) * reach.first + reach.one;
  // Each pair was counted from both sides, and each grain found itself.
  return 0.5 * (in_reach - double(radii.size()));
}

void expect_computable(const Cell& cell) {
  const double volume = cell.volume();
  const Vector3 height = heights(cell);
  const double least = height.head(cell.dimension).minCoeff();
  if (volume > 0 && std::isfinite(volume) && height.head(cell.dimension).allFinite() && least > 0) return;
  throw IncrementFailed("a cell of " + edges_in_words(cell) + " m has a volume of " + in_words(volume) +
                        " m^3 and a least height of " + in_words(least) +
                        " m; both must be above 0 and finite: deform less, and give all lengths in m");
}

void refuse_pairs(double pairs, const Cell& cell, const std::vector<double>& radii, double skin) {
  const double n = double(radii.size());
  throw IncrementFailed("the neighbour list of " + std::to_string(radii.size()) + " grains may need " +
                        in_words(pairs) + " pairs and periodic images, " + in_words(pairs / n) +
                        " a grain; allowed: " + in_words(allowed_pairs(radii.size())) + "; largest diameter " +
                        in_words(2 * *std::max_element(radii.begin(), radii.end())) + " m, cell " +
                        edges_in_words(cell) + " m, skin " + in_words(skin) +
                        " m: are coordinates or radii in mm? Give all in m, or lower solver.skin");
}

void refuse_looks(double looks, const Cell& cell) {
  const Vector3 height = heights(cell);
  throw IncrementFailed("the neighbour list would search " + in_words(looks) +
                        " bins; the cell is very skew or thin: edges " + edges_in_words(cell) + " m, least height " +
                        in_words(height.head(cell.dimension).minCoeff()) +
                        " m; give its shortest lattice vectors, and all lengths in m");
}

}  // namespace rvelab
