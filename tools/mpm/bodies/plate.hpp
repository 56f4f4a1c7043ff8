// Plates of a triaxial test: a half-space across an axis that moves along it alone, pushed by a pressure. V and the
// force F of soil and rocks on it are along its normal n, into the soil:
//
//   M dV/dt = p(t) A(t) - F
//
// A is the area between the faces that bound the specimen along the other axes, where they are at that time. The soil
// is kept out by impulses J_k n at the points of the surface, each of which has a column of nodes of its own: with u_k
// the velocity of the soil there without J_k and m_k its mobility,
//
//   J_k = max(0, V - u_k)/m_k,   M (V - V_0) + sum J_k = 0,   V_0 the velocity without the soil.
//
// The sum rises with V and is linear by parts: Newton's steps from V_0 down end at its root. There is no stiffness, and
// a light plate takes no smaller step than a heavy one.
#pragma once

#include <vector>

#include "tools/mpm/bodies/histories.hpp"

namespace mpm {

/// A boundary, or a body, that bounds a plate.
struct PlateSide {
  bool body = false;
  int number = 0;
};

struct Plate {
  double mass = 0;       ///< kg
  TimeHistory pressure;  ///< Pa
  double until = 1e300;  ///< s; from then on the body has its prescribed velocity
  /// Along each of the other axes, below and above; none: `area` stays as it is.
  std::vector<PlateSide> sides;
  double thickness = 1;     ///< m, of the plane
  double area = 0;          ///< m^2, at the start of the step
  double displacement = 0;  ///< m, and
  double velocity = 0;      ///< m/s, along the normal
  double rock_force = 0;    ///< N, of rocks on it along the normal: mean over the step before
  double held_from = -1;    ///< s, end of its last step under pressure; below 0: it is under pressure
  /// m/s, within a step: without the soil, and with it.
  double free_velocity = 0, met_velocity = 0;
  double force = 0;                 ///< N, of pressure and soil over the step that is made
  double rock_impulse = 0;          ///< N s, over the step that is made
  std::size_t first = 0, last = 0;  ///< its points among those of all surfaces

  bool free() const { return held_from < 0; }
  /// m/s^2, of the largest pressure of all times alone.
  double acceleration() const;
};

struct SurfaceMobility {
  double speed, mobility;  ///< m/s of the soil along the normal without the plate, and of N s
};

/// The root V: m/s.
double plate_velocity(double mass, double free_velocity, const std::vector<SurfaceMobility>& soil);

}  // namespace mpm
