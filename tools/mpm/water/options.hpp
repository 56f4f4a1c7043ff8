// The pore water of a scene, and what its boundaries are to it.
#pragma once

#include <limits>
#include <vector>

namespace mpm {

/// What a boundary is to the water. head: p = rho_f g (value - height), 0 above it.
struct WaterBoundary {
  enum class Kind { impermeable, pressure, head } kind = Kind::impermeable;
  double value = 0;  ///< Pa, or m

  bool open() const { return kind != Kind::impermeable; }
};

struct FluidOptions {
  static constexpr double standard_gravity = 9.81;                ///< m/s^2, of conductivities and heads
  double density = 1000;                                          ///< kg/m^3
  double bulk_modulus = std::numeric_limits<double>::infinity();  ///< Pa
  bool follows_void_ratio = true;                                 ///< the conductivity
  bool drained_surface = true;            ///< no pressure at free surfaces; else they are membranes
  double thickness = 1;                   ///< m, of the plane
  std::vector<WaterBoundary> boundaries;  ///< one a plane
};

}  // namespace mpm
