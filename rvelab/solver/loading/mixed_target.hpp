// What is asked of strain and stress together: constraints A : dE + B : d sigma = c, a row each.
#pragma once

#include <vector>

#include "rvelab/cell/cell.hpp"

namespace rvelab {

/// A mixed target: for each row, A : dE + B : d sigma = c, with dE the symmetric part of the increment of
/// displacement gradient and d sigma the change of Cauchy stress over the increment (laboratory frame). The skew
/// part is given. 2D needs 3 rows over xx, yy, xy; 3D needs 6. Stress is tension positive.
///
/// Rve::apply throws InputError if
///  - the number of rows is not 3 in 2D or 6 in 3D;
///  - an entry of A or B, c or `missed` is not finite;
///  - the rows depend on each other, one of them is empty (A = B = 0), or, with the stiffness C that the contacts have
///    now, A + B C cannot be inverted: the rows then do not determine the strain;
///  - a row with a stress (B != 0) has no finite scale > 0;
///  - the spin is not finite or not skew, to 1e-12 of its norm;
///  - the volume ratio is negative or not finite;
///  - the tolerance is not finite or not > 0.
/// It throws InvalidIncrement if the gradient on the way to the target turns the cell inside out (det(I + dH) <= 0). In
/// the plane the z components of A and B are ignored.
struct MixedTarget {
  struct Row {
    Matrix3 strain = Matrix3::Zero();  ///< A, dimensionless, symmetric; A : dE sums all nine entries
    Matrix3 stress = Matrix3::Zero();  ///< B, 1/Pa or dimensionless; units of c decide
    double value = 0;                  ///< c
    double scale = 0;                  ///< rows with stress: |residual| <= tolerance * scale counts as held; > 0
    double missed = 0;  ///< part of `value` that the increment before has left; at a rate: made good as fast
                        ///< as the control can, the rest goes evenly over the increment
  };
  std::vector<Row> rows;
  Matrix3 spin =
      Matrix3::Zero();       ///< dimensionless, laboratory frame: skew part of the increment of displacement gradient
  double volume_ratio = 0;   ///< > 0: det(I + dH), met to round-off by an isotropic strain beside the rows' (of
                             ///< second order in theirs where they prescribe the volume to first order)
  double tolerance = 0.005;  ///< > 0, relative to each row's scale; at a rate: of the mean over the increment, since
                             ///< the stress of the moment fluctuates with the collisions
  /// Quasi-static: < 0: the target waits until its stresses are held (quasi_static/recovery.hpp). Else its end waits so
  /// many sub-steps, or a quarter of those that it took where that is more, for callers that correct what is missed in
  /// rounds.
  long wait = -1;
};

}  // namespace rvelab
