// What a collision of two grains comes to without damping. Two grains of the given reduced mass (kg) approach at
// `speed` (m/s): f_n = constant overlap (linear, N/m) or constant overlap^1.5 (Hertz, N/m^1.5; Landau and Lifshitz,
// Theory of Elasticity, section 9).
#pragma once

#include <cmath>

#include "tests/specimens.hpp"

namespace rvelab::test {

struct Impact {
  double overlap = 0;   ///< largest, m
  double duration = 0;  ///< of the contact, s
};

inline Impact impact_of(bool hertz, double constant, double reduced_mass, double speed) {
  if (!hertz) return {speed * std::sqrt(reduced_mass / constant), pi * std::sqrt(reduced_mass / constant)};
  const double overlap = std::pow(1.25 * reduced_mass * speed * speed / constant, 0.4);
  return {overlap, 2.943275 * overlap / speed};
}

/// The constant for which the largest overlap (m) is that.
inline double constant_for(bool hertz, double overlap, double reduced_mass, double speed) {
  return hertz ? 1.25 * reduced_mass * speed * speed / std::pow(overlap, 2.5)
               : reduced_mass * speed * speed / (overlap * overlap);
}

}  // namespace rvelab::test
