// Rows and pairs of ellipses.
//
// Declared in outline.hpp.
#include <algorithm>

#include "rvelab/solver/assembly/outline.hpp"
#include "rvelab/solver/kernels/ellipses.hpp"

namespace rvelab {
namespace {

template <class Gap>
OutlinePlace place_at(const Branch& b, Direction<double> n, const Gap& gap) {
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

EllipsePair<double> pair_of(const Branch& b, const double* row_i, const double* row_j) {
  const auto matrix = [](const double* row) { return matrix_from(row[8], row[9], row[10], row[11]); };
  return {b.x, b.y, matrix(row_i), matrix(row_j)};
}

}  // namespace

template <>
void Outline<Shape::ellipse>::complete_row(const Own& own, double* row) {
  const auto [minor_squared, difference] = Ellipse::turn_values(own);
  row[7] = Ellipse::extent(own).turning;
  const EllipseMatrix<double> m = ellipse_matrix<double>({row[5], row[6]}, minor_squared, difference,
                                                         own.semi_minor * own.semi_minor / own.semi_major);
  const double values[4] = {m.xx, m.xy, m.yy, m.sharpest};
  std::copy_n(values, 4, row + 8);
}

template <>
OutlinePlace Outline<Shape::ellipse>::place(const Branch& b, const double* row_i, const double* row_j) {
  const EllipsePlace<double> place = closest_place(pair_of(b, row_i, row_j));
  return place_at(b, place.n, place);
}

template <>
OutlinePlace Outline<Shape::ellipse>::nearest_place(const OutlinePlace& apart, const double* row_i,
                                                    const double* row_j) {
  // f is convex where it is below 0: from a direction that shows the pair apart the steps end at the distance.
  const EllipsePair<double> pair = pair_of(apart.branch, row_i, row_j);
  Direction<double> n = {apart.normal.x, apart.normal.y};
  EllipseGap<double> gap = ellipse_gap(pair, n);
  for (int step = 1; step < halley_steps && !is_least_nearby(gap); ++step) {
    n = next_direction(n, gap);
    gap = ellipse_gap(pair, n);
  }
  return place_at(apart.branch, n, gap);
}

/// Of one packing, instructions a grain-step (v3) with circles, with the first direction alone and with the steps to
/// the distance: 1292, 627, 597 at aspect 1/10, 447, 432, 434 at 0.743.
template <>
bool Outline<Shape::ellipse>::farther_apart_than(double skin, const Branch& b, const double* row_i,
                                                 const double* row_j) {
  const EllipsePair<double> p = pair_of(b, row_i, row_j);
  Direction<double> n = first_direction(p);
  EllipseGap<double> g = ellipse_gap(p, n);
  for (int step = 1; step < halley_steps && g.overlap >= -skin && !is_least_nearby(g); ++step) {
    n = next_direction(n, g);
    g = ellipse_gap(p, n);
  }
  return g.overlap < -skin;
}

}  // namespace rvelab
