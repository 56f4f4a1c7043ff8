// Geometry of listed pairs, inline: checks go through all pairs every few dozen sub-steps.
#pragma once

#include "rvelab/solver/assembly/assembly.hpp"
#include "rvelab/solver/assembly/outline.hpp"

namespace rvelab {

/// Pairs of grains of a shape from the arrays of an assembly.
template <Shape shape>
class PairGeometry {
 public:
  static constexpr int D = dimension_of(shape);

  PairGeometry(const Model& f, const Assembly& a)
      : rows_(a.rows.data()),
        radius_(f.radius.data()),
        i_(a.pairs.row_i.data()),
        j_(a.pairs.row_j.data()),
        grain_i_(a.pairs.i.data()),
        grain_j_(a.pairs.j.data()),
        lattice_(upper_triangle(a.cell.lattice)) {
    for (int k = 0; k < D; ++k) image_[k] = a.pairs.image_number[k].data();
  }

  auto operator()(std::size_t p) const {
    const Branch b = branch(p);
    if constexpr (!is_round(shape)) {
      return Outline<shape>::place(b, rows_ + i_[p], rows_ + j_[p]);
    } else {
      const double length = b.length();
      return PairPlace{b, length, (radius_[grain_i_[p]] + radius_[grain_j_[p]]) - length};
    }
  }
  /// The same, but of outlines that are apart by less than `gap` (m) the true distance: an overlap < 0 else shows that
  /// they are apart, not how far.
  auto within(std::size_t p, double gap) const {
    auto place = (*this)(p);
    if constexpr (!is_round(shape)) {
      if (place.overlap < 0 && -place.overlap < gap)
        place = Outline<shape>::nearest_place(place, rows_ + i_[p], rows_ + j_[p]);
    }
    return place;
  }
  Branch branch(std::size_t p) const {
    const double *xi = rows_ + i_[p], *xj = rows_ + j_[p];
    const double nx = image_[0][p], ny = image_[1][p];
    if constexpr (D == 2)
      return {(xj[0] - xi[0]) + (lattice_.xx * nx + lattice_.xy * ny), (xj[1] - xi[1]) + lattice_.yy * ny, 0};
    const double nz = image_[D - 1][p];
    return {(xj[0] - xi[0]) + (lattice_.xx * nx + (lattice_.xy * ny + lattice_.xz * nz)),
            (xj[1] - xi[1]) + (lattice_.yy * ny + lattice_.yz * nz), (xj[2] - xi[2]) + lattice_.zz * nz};
  }

 private:
  const double *rows_, *radius_;
  const std::int32_t *i_, *j_, *grain_i_, *grain_j_;
  const double* image_[D];
  UpperTriangle lattice_;
};

/// visit(p, place) for each listed pair that touches, in the order of every sum.
template <Shape shape, class Visit>
void each_touching(const Model& f, const Assembly& a, const Visit& visit) {
  const PairGeometry<shape> pair(f, a);
  for (const std::int32_t listed : a.pairs.order) {
    const auto p = std::size_t(listed);
    if (const auto at = pair(p); at.overlap > 0) visit(p, at);
  }
}

}  // namespace rvelab
