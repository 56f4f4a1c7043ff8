// Stiffness probes: the response of an RVE to small strains, either of each component, plus and minus, or in
// directions close to the loading direction of a test.
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
  double unbalanced_ratio = 0;       ///< largest remaining one
  double plus_minus_difference = 0;  ///< largest |C+ - C-| over the largest |C|; slip and openings show here
  bool relaxed = true;               ///< unbalanced_ratio < relaxed_ratio
};

/// d(sigma)/d(strain) by quasi-static increments of +-size (0 < size <= 0.01, InputError else), each from a copy of the
/// RVE, relaxed at fixed cell without zeroing velocities between (which would lose the last slip). A probe that does
/// not relax within `max_steps` is returned with relaxed = false: its stiffness is then off by about unbalanced ratio
/// times p over size. IncrementFailed as apply.
Probe probe_stiffness(const Rve& rve, double size, long max_steps = 2'000'000);

/// Strain of a loading probe: larger than the strain after which contacts of a relaxed state slide again, smaller than
/// the strains over which a test hardens.
inline constexpr double usual_loading_probe = 1e-3, smallest_loading_probe = 1e-5, largest_loading_probe = 1e-2;

/// The stiffness of continued loading: d(sigma)/d(strain) near one direction of strain, without averaging with
/// unloading, which has a different response in an assembly with sliding contacts. `direction`: its symmetric part is
/// used, of any length, laboratory frame. With d0 of unit length (Frobenius) along it, t of unit length across it,
/// a = 0.3:
///   D d0 = s(d0),   D t = (s(d0 + a t) - s(d0 - a t))/2a
/// s(d): change of stress over strain in the second half of the straight path size d from a copy of the RVE. In the
/// first half contacts begin to slide and the lag of the state decays: relaxed and unrelaxed copies then give the same.
/// At the peak of biaxial tests det of the acoustic tensor is -0.02 +- 0.01 of the elastic one; by probe_stiffness,
/// which averages loading and unloading, 0.44 (tools/validate bands).
/// InputError without a direction, or unless smallest_loading_probe <= size <= largest_loading_probe. IncrementFailed
/// as apply.
Eigen::MatrixXd loading_stiffness(const Rve& rve, const Matrix3& direction, double size = usual_loading_probe);

/// Friction and rolling friction so large (1e6) that no contact slips: the state of the elastic tangent.
void forbid_slip(Rve& rve);

/// Names of the components in order, "xx" and so on.
std::vector<std::string> component_names(int dimension);

}  // namespace rvelab
