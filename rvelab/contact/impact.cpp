#include "rvelab/contact/impact.hpp"

#include <cmath>

namespace rvelab {

double fifth_root(double x) {
  if (!(x > 0) || !std::isfinite(x)) return x > 0 ? x : 0;
  int exponent = 0;
  double mantissa = std::frexp(x, &exponent);                        // exact: x = mantissa 2^exponent
  const int fifths = (exponent >= 0 ? exponent : exponent - 4) / 5;  // rounded down: units of 2^k change no other bit
  mantissa = std::ldexp(mantissa, exponent - 5 * fifths);            // 1/2 to 16
  double root = 1;
  for (int k = 0; k < 16; ++k) {
    const double squared = root * root;
    root += 0.2 * (mantissa / (squared * squared) - root);
  }
  return std::ldexp(root, fifths);
}

}  // namespace rvelab
