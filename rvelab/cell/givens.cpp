// Givens rotations: see givens.hpp.
#include "rvelab/cell/givens.hpp"

#include <cmath>

namespace rvelab {
namespace {

// Rotates rows p and q so that entry (q, p) vanishes and the pivot (p, p) becomes positive.
void annihilate(TriangularFactors& factors, int p, int q) {
  const double a = factors.upper(p, p);
  const double b = factors.upper(q, p);
  if (b == 0.0 && a >= 0.0) return;
  const double length = std::sqrt(a * a + b * b);
  const double c = a / length;
  const double s = b / length;
  for (int k = 0; k < 3; ++k) {
    const double upper_p = factors.upper(p, k), upper_q = factors.upper(q, k);
    factors.upper(p, k) = c * upper_p + s * upper_q;
    factors.upper(q, k) = c * upper_q - s * upper_p;
    const double rotation_p = factors.rotation(k, p), rotation_q = factors.rotation(k, q);
    factors.rotation(k, p) = c * rotation_p + s * rotation_q;
    factors.rotation(k, q) = c * rotation_q - s * rotation_p;
  }
  factors.upper(p, p) = length;
  factors.upper(q, p) = 0.0;
}

}  // namespace

TriangularFactors triangular_factors(const Matrix3& matrix) {
  TriangularFactors factors{Matrix3::Identity(), matrix};
  // The pivot's sign is put right by the neighbouring row, so that in 2D the z-row never takes part.
  annihilate(factors, 0, 1);
  annihilate(factors, 0, 2);
  annihilate(factors, 1, 2);
  // Three rotations leave R off the orthogonal matrices by some units of round-off, which would add up in the frame.
  factors.rotation = renormalised(factors.rotation);
  // Adding zero turns -0 into +0: equal states then are equal bit for bit.
  factors.rotation.array() += 0.0;
  factors.upper.array() += 0.0;
  return factors;
}

}  // namespace rvelab
