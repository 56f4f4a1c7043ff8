#include "rvelab/solver/assembly/pair_place.hpp"

#include "rvelab/solver/kernels/ellipses.hpp"

namespace rvelab {

EllipsePlace place_of_ellipses(const Branch& b, const double* row_i, const double* row_j) {
  const auto matrix = [](const double* row) { return matrix_from(row[8], row[9], row[10], row[11]); };
  const EllipsePair<double> pair = {b.x, b.y, matrix(row_i), matrix(row_j)};
  Direction<double> n = first_direction(pair);
  const EllipseGap<double> gap = closest_gap(pair, n);
  const double half_slope = 0.5 * gap.slope;
  return {b,
          b.length(),
          gap.overlap,
          {n.x, n.y, 0},
          gap.support_i,
          gap.support_j,
          gap.turned_i - half_slope,
          gap.turned_j - half_slope};
}

}  // namespace rvelab
