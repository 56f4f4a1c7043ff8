#include "rvelab/solver/assembly/oriented_bounds.hpp"

#include "rvelab/solver/kernels/ellipses.hpp"

namespace rvelab {

namespace {

/// Whether the distance is above `skin`. Of one packing, instructions a grain-step (v3) with circles, with the first
/// direction alone and with the steps to the distance: 1292, 627, 597 at aspect 1/10, 447, 432, 434 at 0.743.
bool farther_apart_than(double skin, const EllipsePair<double>& p) {
  Direction<double> n = first_direction(p);
  EllipseGap<double> g = ellipse_gap(p, n);
  for (int step = 1; step < halley_steps && g.overlap >= -skin && !is_least_nearby(g); ++step) {
    n = next_direction(n, g);
    g = ellipse_gap(p, n);
  }
  return g.overlap < -skin;
}

}  // namespace

void keep_near_ellipses(const Model& f, const Assembly& a, double skin, std::vector<ListedPair>& pairs) {
  const UpperTriangle l = upper_triangle(a.cell.lattice);
  const auto matrix = [](const double* row) { return matrix_from(row[8], row[9], row[10], row[11]); };
  std::vector<std::uint8_t> near(pairs.size());
  in_pieces(pairs.size(), f.sharing(), [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      const double *xi = a.rows.data() + std::size_t(pairs[k].i) * std::size_t(f.row_length()),
                   *xj = a.rows.data() + std::size_t(pairs[k].j) * std::size_t(f.row_length());
      const Image& n = pairs[k].image;
      const double x = xj[0] - xi[0] + (l.xx * n[0] + l.xy * n[1]), y = xj[1] - xi[1] + l.yy * n[1];
      near[k] = !farther_apart_than(skin, {x, y, matrix(xi), matrix(xj)});
    }
  });
  std::size_t kept = 0;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (near[k]) pairs[kept++] = pairs[k];
  pairs.resize(kept);
}

}  // namespace rvelab
