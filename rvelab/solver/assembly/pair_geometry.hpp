// Geometry of listed pairs, inline: control looks at all pairs every few dozen sub-steps.
#pragma once

#include <cmath>

#include "rvelab/solver/assembly/assembly.hpp"

namespace rvelab {

/// Branch of a listed pair, m, cell frame.
struct Branch {
  double x, y, z;
  double length() const { return std::sqrt(x * x + y * y + z * z); }
};

/// A listed pair as its grains lie now; m, cell frame.
struct PairPlace {
  Branch branch;
  double length, overlap;
};

/// Pairs in D dimensions from the arrays of an assembly.
template <int D>
class PairGeometry {
 public:
  PairGeometry(const Fixture& f, const Assembly& a)
      : rows_(a.rows.data()),
        radius_(f.radius.data()),
        i_(a.pairs.row_i.data()),
        j_(a.pairs.row_j.data()),
        grain_i_(a.pairs.i.data()),
        grain_j_(a.pairs.j.data()),
        lattice_(upper_triangle(a.cell.lattice)) {
    for (int k = 0; k < D; ++k) image_[k] = a.pairs.image_number[k].data();
  }

  PairPlace operator()(std::size_t p) const {
    const Branch b = branch(p);
    const double length = b.length();
    return {b, length, (radius_[grain_i_[p]] + radius_[grain_j_[p]]) - length};
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

}  // namespace rvelab
