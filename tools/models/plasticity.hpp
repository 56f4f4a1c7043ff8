// Rates of an elastoplastic element with up to two yield mechanisms, in axial and radial components.
#pragma once

#include "tools/models/element.hpp"

namespace rvelab::models {

constexpr double degree = 0.017453292519943295;

/// Isotropic elasticity.
struct Elasticity {
  double bulk, shear;
  /// Stress rates of strain rates.
  std::array<double, 2> operator()(double a, double r) const {
    const double volume = (bulk - 2 * shear / 3) * (a + 2 * r);
    return {volume + 2 * shear * a, volume + 2 * shear * r};
  }
};

/// One mechanism: its yield function f grows by normal . d(sigma), hardens by `hardening` per unit of multiplier, and a
/// multiplier of one is the plastic strain `flow` (axial, radial).
struct Mechanism {
  bool active = false;  ///< the stress is on its yield surface
  std::array<double, 2> normal{}, flow{};
  double hardening = 0;
  double drift = 0;  ///< growth of f from anything else
};

struct PlasticRate {
  std::array<double, 2> stress;
  std::array<double, 2> multiplier;
};

/// Koiter's rule: the multipliers are positive where f stays zero, and zero where f falls.
PlasticRate plastic_rate(const Elasticity& elastic, const std::array<Mechanism, 2>& mechanisms, StrainRate d);

}  // namespace rvelab::models
