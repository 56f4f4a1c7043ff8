// Continuum laws as a scene names them. A further law is a class beside Elastic and Plastic, a function that reads its
// keys, and its line in continuum.cpp.
#pragma once

#include <functional>
#include <memory>

#include "tools/mpm/keys/keys.hpp"
#include "tools/mpm/materials/material.hpp"

namespace mpm {

/// A law with its parameters.
struct Continuum {
  double wave_modulus = 0;  ///< Pa, of plane waves at the start
  std::function<std::shared_ptr<Material<2>>()> plane;
  std::function<std::shared_ptr<Material<3>>()> space;

  template <int D>
  std::shared_ptr<Material<D>> make() const {
    if constexpr (D == 2)
      return plane();
    else
      return space();
  }
};

/// Makes Law<2>(parameters...) and Law<3>(parameters...).
template <template <int> class Law, class... Parameters>
Continuum continuum_of(double wave_modulus, const Parameters&... parameters) {
  return {wave_modulus, [=] { return std::make_shared<Law<2>>(parameters...); },
          [=] { return std::make_shared<Law<3>>(parameters...); }};
}

struct ContinuumKind {
  const char* name;  ///< in a scene
  Continuum (*read)(Keys& keys);
};
extern const std::vector<ContinuumKind> continuum_kinds;

}  // namespace mpm
