#include "rvelab/solver/assembly/pair_place.hpp"

#include "rvelab/solver/kernels/ellipses.hpp"

namespace rvelab {
namespace {

EllipsePlace place_of(const Branch& b, const EllipsePair<double>& pair) {
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

}  // namespace

EllipsePlace place_of_ellipses(const Branch& b, const double* row_i, const double* row_j) {
  const auto matrix = [](const double* row) { return matrix_from(row[8], row[9], row[10], row[11]); };
  return place_of(b, {b.x, b.y, matrix(row_i), matrix(row_j)});
}

EllipsePlace place_of_ellipses(const Branch& b, const EllipseForm& i, const EllipseForm& j) {
  const auto matrix = [](const EllipseForm& e) {
    return ellipse_matrix<double>({e.axis_x, e.axis_y}, e.semi_minor * e.semi_minor,
                                  (e.semi_major - e.semi_minor) * (e.semi_major + e.semi_minor),
                                  e.semi_minor * e.semi_minor / e.semi_major);
  };
  return place_of(b, {b.x, b.y, matrix(i), matrix(j)});
}

}  // namespace rvelab
