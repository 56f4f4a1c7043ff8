#include "rvelab/contact/restitution.hpp"

#include <cmath>

namespace rvelab {
namespace {

constexpr double pi = 3.14159265358979323846;

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

/// exp(-x) for x >= 0: the series of exp(x / 2^k), squared k times.
double exponential_of_minus(double x) {
  int halvings = 0;
  for (; x > 0.1; x /= 2) ++halvings;
  double sum = 1;
  for (int term = 12; term >= 1; --term) sum = 1 - x / term * sum;
  for (; halvings > 0; --halvings) sum *= sum;
  return sum;
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
  return zeta / root * natural_logarithm((zeta + root) / (zeta - root));
}

}  // namespace

double restitution_of(double zeta, bool no_tension) {
  if (zeta <= 0) return 1;
  if (no_tension) return exponential_of_minus(decay_without_tension(zeta));
  return zeta < 1 ? exponential_of_minus(pi * zeta / std::sqrt(1 - zeta * zeta)) : 0.0;
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
