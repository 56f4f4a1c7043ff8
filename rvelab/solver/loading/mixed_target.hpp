// What is asked of strain and stress together: rows A : dE + B : d sigma = c.
#pragma once

#include <vector>

#include "rvelab/cell/cell.hpp"

namespace rvelab {

/// A mixed target: for each row, A : dE + B : d sigma = c, with dE the symmetric part of the increment of
/// displacement gradient and d sigma the change of Cauchy stress over the increment (laboratory frame). The skew
/// part is given. 2D needs 3 rows over xx, yy, xy; 3D needs 6. Rows must be independent.
struct MixedTarget {
  struct Row {
    Matrix3 strain = Matrix3::Zero();  ///< A, dimensionless, symmetric; A : dE sums all nine entries
    Matrix3 stress = Matrix3::Zero();  ///< B, 1/Pa or dimensionless; units of c decide
    double value = 0;                  ///< c
    double scale = 0;                  ///< rows with stress: |residual| <= tolerance * scale counts as held; > 0
    double missed = 0;  ///< part of `value` that the increment before has left; dt > 0: made good as fast
                        ///< as the control can, the rest goes evenly over the increment
  };
  std::vector<Row> rows;
  Matrix3 spin = Matrix3::Zero();  ///< skew part of the increment of displacement gradient
  double volume_ratio = 0;         ///< > 0: det(I + dH), met to round-off by an isotropic strain beside the rows' (of
                                   ///< second order in theirs where they prescribe the volume to first order)
  double tolerance = 0.005;        ///< relative to each row's scale; dt > 0: of the mean over the increment, since the
                                   ///< stress of the moment fluctuates with the collisions
  long wait = 200;                 ///< dt = 0: sub-steps that the end of the increment may wait for the stress, or a
                    ///< quarter of those that it took where that is more; dt > 0: no wait, since it would
                    ///< let time pass without strain
};

}  // namespace rvelab
