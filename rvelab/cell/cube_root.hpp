// A cube root with the same bits on every machine, which the standard library does not guarantee.
#pragma once

namespace rvelab {

/// Cube root of a positive number by Newton's method.
inline double cube_root(double value) {
  double scale = 1.0;
  while (value >= 8.0) {
    value /= 8.0;
    scale *= 2.0;
  }
  while (value < 1.0) {
    value *= 8.0;
    scale /= 2.0;
  }
  double root = 1.5;
  for (int k = 0; k < 8; ++k) root = (2.0 * root + value / (root * root)) / 3.0;
  return scale * root;
}

}  // namespace rvelab
