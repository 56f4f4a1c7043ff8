// What a collision of two grains comes to without damping.
#pragma once

namespace rvelab::stress_test {

struct Impact {
  double overlap = 0;   ///< largest, m
  double duration = 0;  ///< of the contact, s
};

/// Two grains of the given reduced mass (kg) that approach at `speed` (m/s): f_n = constant overlap (linear, N/m) or
/// constant overlap^1.5 (Hertz, N/m^1.5; Landau and Lifshitz, Theory of Elasticity, section 9).
Impact impact_of(bool hertz, double constant, double reduced_mass, double speed);

/// The constant for which the largest overlap (m) is that.
double constant_for(bool hertz, double overlap, double reduced_mass, double speed);

}  // namespace rvelab::stress_test
