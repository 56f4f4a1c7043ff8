#include "rvelab/contact/impact.hpp"

#include <cmath>
#include <numbers>

#include "rvelab/cell/cube_root.hpp"

namespace rvelab {
namespace {

using std::numbers::pi;

/// ln(x) for x > 0: x = m 2^k with m near 1, ln m = 2 artanh((m - 1)/(m + 1)).
double natural_logarithm(double x) {
  constexpr double ln_2 = 0.693147180559945309417;
  double power = 0;
  for (; x < 0.70710678118654752; x *= 2) power -= 1;
  for (; x > 1.41421356237309505; x /= 2) power += 1;
  const double z = (x - 1) / (x + 1);
  double sum = 0;  // |z| <= 0.1716, z^24 < 5e-19
  for (int term = 23; term >= 1; term -= 2) sum = sum * (z * z) + 1.0 / term;
  return power * ln_2 + 2 * z * sum;
}

/// atan(x) for x >= 0: three halvings of the angle, then the series.
double arc_tangent(double x) {
  double factor = 1;
  for (int halving = 0; halving < 3; ++halving) {
    x = x / (1 + std::sqrt(1 + x * x));
    factor *= 2;
  }
  double sum = 0;  // x <= tan(pi/16) = 0.199, x^26 < 1e-18
  for (int term = 25; term >= 1; term -= 2) sum = 1.0 / term - sum * (x * x);
  return factor * x * sum;
}

/// Duration of the contact times the decay rate: -ln e, where the contact ends with the force.
double decay_without_tension(double zeta) {
  const double under = 1 - zeta * zeta;
  if (under > 1e-8) {
    // cos a = zeta: the force is a decaying sine that ends at pi - 2 asin(zeta) = 2 a, in units of the damped period.
    const double root = std::sqrt(under);
    return zeta / root * 2 * arc_tangent(root / zeta);
  }
  if (under > -1e-8) return 2;  // critical: both sides meet here
  const double root = std::sqrt(-under);
  // (zeta + root)/(zeta - root) = (zeta + root)^2, which a large zeta does not divide by zero.
  return zeta / root * (2 * natural_logarithm(zeta + root));
}

}  // namespace

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

double ConeImpact::frequency(double measure) { return measure > 0 ? std::sqrt(2 * cube_root(1.5 * measure)) : 0; }

double ConeImpact::reach(double k, double mass, double v, double /*own*/) {
  const double cubed = 1.5 * mass * v * v / k;
  return cubed > 0 && std::isfinite(cubed) ? cube_root(cubed) : cubed;
}

double damping_ratio(double restitution, bool no_tension) {
  if (restitution >= 1) return 0;
  const double wanted = -natural_logarithm(restitution);
  if (!no_tension) return wanted / std::sqrt(pi * pi + wanted * wanted);
  // The decay grows with zeta, as 2 ln(2 zeta) in the end: doubling, then bisection to the last bit.
  double low = 0, high = 1;
  for (; decay_without_tension(high) < wanted; high *= 2) low = high;
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (low + high);
    (decay_without_tension(middle) < wanted ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace rvelab
