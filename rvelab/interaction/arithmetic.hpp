// Roots and cosines by + - x / alone, so that what enters the state has the same bits with every mathematical library.
#pragma once

namespace rvelab::interaction {

/// x > 0; Newton's steps from a power of two.
inline double cube_root(double x) {
  if (!(x > 0)) return 0;
  int exponent = 0;
  const double fraction = __builtin_frexp(x, &exponent);  // 0.5 to 1
  int thirds = exponent / 3, rest = exponent - 3 * thirds;
  if (rest < 0) {
    rest += 3;
    thirds -= 1;
  }
  const double reduced = fraction * double(1 << rest);  // 0.5 to 4
  double root = 0.6 + 0.26 * reduced;
  for (int step = 0; step < 6; ++step) root -= (root - reduced / (root * root)) / 3;
  return __builtin_ldexp(root, thirds);
}

/// |x| up to pi/2: Taylor's series, to the last bits.
inline double cosine(double x) {
  const double square = x * x;
  double sum = 1;
  for (int k = 24; k >= 2; k -= 2) sum = 1 - square / double(k * (k - 1)) * sum;
  return sum;
}

}  // namespace rvelab::interaction
