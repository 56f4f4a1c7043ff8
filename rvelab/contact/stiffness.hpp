// What a law makes of two grains, and the mean that laws mix by.
#pragma once

namespace rvelab {

/// Constants of one contact: f_n and the current stiffnesses follow from them and the overlap.
struct ContactConstants {
  double kn = 0, kt = 0;
  double law_constant = 0;  ///< one more, of laws that have one
};

/// 2ab/(a + b), zero if either is zero.
static inline double harmonic_mean(double a, double b) { return a > 0 && b > 0 ? 2 * (a * b) / (a + b) : 0.0; }

}  // namespace rvelab
