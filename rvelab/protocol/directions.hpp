// Directions in a plane without libm, since they decide bits of a state. Internal to the module.
#pragma once

namespace rvelab::protocol {

struct UnitVector {
  double cosine, sine;
};

/// At `turns` of a full circle; error some 1e-15 within a circle.
inline UnitVector unit_vector(double turns) {
  constexpr double two_pi = 6.283185307179586476925;
  constexpr int squarings = 8;
  const double x = two_pi * turns / (1 << squarings), square = x * x;
  // 1 - cos and sin by their series, then doubling: 1 - cos 2x = 2 sin^2 x.
  double versine = 0.5 * square * (1 - square / 12 * (1 - square / 30 * (1 - square / 56)));
  double sine = x * (1 - square / 6 * (1 - square / 20 * (1 - square / 42)));
  for (int k = 0; k < squarings; ++k) {
    const double next = 2 * sine * (1 - versine);
    versine = 2 * sine * sine;
    sine = next;
  }
  return {1 - versine, sine};
}

}  // namespace rvelab::protocol
