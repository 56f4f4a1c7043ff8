// Stiffness probes: the response of an RVE to small strains, one component at a time, plus and minus.
//
// Rows are the symmetric part of the Cauchy stress (tension positive, Pa), columns strains with engineering shear
// (dH_xy = dH_yx = gamma/2), laboratory frame; order of tensor_order.hpp: xx yy xy in 2D, xx yy zz yz xz xy in 3D.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "rvelab/solver/rve.hpp"

namespace rvelab {

/// Unbalanced ratio below which a probed state counts as relaxed.
inline constexpr double relaxed_ratio = 1e-10;

struct Probe {
  Eigen::MatrixXd stiffness;         ///< Pa, mean of plus and minus
  double size = 0;                   ///< strain of each probe, dimensionless
  double unbalanced_ratio = 0;       ///< the largest that was left
  double plus_minus_difference = 0;  ///< largest |C+ - C-| over the largest |C|; slip and openings show here
  bool relaxed = true;               ///< unbalanced_ratio < relaxed_ratio
};

/// d(sigma)/d(strain) by quasi-static increments of +-size (0 < size <= 0.01, InputError else), each from a copy of the
/// RVE, relaxed at fixed cell without zeroing velocities between (which would lose the last slip). A probe that does
/// not relax within `max_steps` is returned with relaxed = false: its stiffness is then off by about unbalanced ratio
/// times p over size. IncrementFailed as apply.
Probe probe_stiffness(const Rve& rve, double size, long max_steps = 2'000'000);

/// Friction and rolling friction so large (1e6) that no contact slips: the state of the elastic tangent.
void forbid_slip(Rve& rve);

/// Names of the components in order, "xx" and so on.
std::vector<std::string> component_names(int dimension);

}  // namespace rvelab
