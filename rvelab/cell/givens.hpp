// Factorisation into a rotation and an upper triangular matrix, by Givens rotations. Shared by the split of an
// increment, the reduction and the oriented starts; it knows matrices only, no cell.
#pragma once

#include "rvelab/cell/cell.hpp"

namespace rvelab {

/// M = R U with R a proper rotation and U upper triangular.
struct TriangularFactors {
  Matrix3 rotation;  ///< R, det +1
  Matrix3 upper;     ///< U; entries below the diagonal are exactly zero
};

/// Factors M (any unit). The first two diagonal entries of U are positive, the third has the sign of det M; a
/// singular M gives a zero, negative or NaN diagonal entry, which the caller checks. Only + - * / sqrt are used. A
/// rotation is made only where an entry below the diagonal is not zero or a diagonal entry is negative: an upper
/// triangular M with positive diagonal comes back untouched with R = I, a signed permutation comes out exactly, and
/// a matrix with z-components (0, 0, m) keeps them. (Golub and Van Loan, Matrix Computations, section 5.1.8.)
TriangularFactors triangular_factors(const Matrix3& matrix);

}  // namespace rvelab
