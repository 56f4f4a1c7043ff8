// How a step is made, as a scene chooses it.
#pragma once

#include "tools/mpm/grid/shape.hpp"

namespace mpm {

enum class Scheme { usf, musl };

template <int D>
struct Options {
  Shape shape = Shape::bspline;
  Scheme scheme = Scheme::usf;
  double pic_fraction = 0.1;
  /// Points bring v + grad v (x - x_p) to a node, not v alone: fields that are linear in space then reach the nodes
  /// unsmoothed, at free surfaces too.
  bool affine = true;
  double cfl = 0.4;                 ///< of the time that a wave takes across a cell
  Vec<D> gravity = Vec<D>::Zero();  ///< m/s^2
  /// Pa, compression positive, on every free surface: the traction's nodal forces, by the divergence theorem, are those
  /// of a uniform stress in the whole body. It moves with the surface, and equilibrium with it is exact.
  double surface_pressure = 0;
};

/// Steps, and sub-steps of rocks, that a run may have before it: one that asks for more would never end.
inline constexpr double most_steps = 1e11;

}  // namespace mpm
