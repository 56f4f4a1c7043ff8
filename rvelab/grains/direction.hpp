// Directions in the plane from angles.
#pragma once

#include <array>
#include <cmath>

namespace rvelab {

/// Cosine and sine of an angle of at most 360 degrees, to 1e-14, by + - * / and the square root alone: the same bits on
/// every machine. The series of a 64th of the angle, doubled six times.
inline std::array<double, 2> direction_of(double degrees) {
  const double x = degrees * (3.14159265358979323846 / 180 / 64), xx = x * x;
  double c = 1 - xx / 2 * (1 - xx / 12 * (1 - xx / 30 * (1 - xx / 56 * (1 - xx / 90))));
  double s = x * (1 - xx / 6 * (1 - xx / 20 * (1 - xx / 42 * (1 - xx / 72))));
  for (int doubling = 0; doubling < 6; ++doubling) {
    const double next = c * c - s * s;
    s = 2 * c * s;
    c = next;
  }
  const double length = std::sqrt(c * c + s * s);
  return {c / length, s / length};
}

}  // namespace rvelab
