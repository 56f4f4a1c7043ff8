#include "rvelab/solver/assembly/pair_place.hpp"

#include "rvelab/solver/kernels/ellipses.hpp"

namespace rvelab {
namespace {

EllipsePlace place_at(const Branch& b, Direction<double> n, const EllipseGap<double>& gap) {
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

EllipsePlace place_of(const Branch& b, const EllipsePair<double>& pair) {
  Direction<double> n = first_direction(pair);
  const EllipseGap<double> gap = closest_gap(pair, n);
  return place_at(b, n, gap);
}

EllipsePair<double> pair_of_rows(const Branch& b, const double* row_i, const double* row_j) {
  const auto matrix = [](const double* row) { return matrix_from(row[8], row[9], row[10], row[11]); };
  return {b.x, b.y, matrix(row_i), matrix(row_j)};
}

}  // namespace

EllipsePlace place_of_ellipses(const Branch& b, const double* row_i, const double* row_j) {
  return place_of(b, pair_of_rows(b, row_i, row_j));
}

EllipsePlace nearest_place_of_ellipses(const EllipsePlace& apart, const double* row_i, const double* row_j) {
  // f is convex where it is below 0: from a direction that shows the pair apart the steps end at the distance.
  const EllipsePair<double> pair = pair_of_rows(apart.branch, row_i, row_j);
  Direction<double> n = {apart.normal.x, apart.normal.y};
  EllipseGap<double> gap = ellipse_gap(pair, n);
  for (int step = 1; step < halley_steps && !is_least_nearby(gap); ++step) {
    n = next_direction(n, gap);
    gap = ellipse_gap(pair, n);
  }
  return place_at(apart.branch, n, gap);
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
