// Elastic tangent of a contact network: the stiffness of the grain assembly while no contact slips, opens or closes.
//
// C_ab = d(Cauchy stress)_a / d(strain)_b in the laboratory frame, Pa, tension positive, strain = sym dH with
// engineering shear; order xx yy zz yz xz xy in 3D (6 x 6), xx yy xy in 2D (3 x 3). Rows are the symmetric part of the
// stress. Initial-stress terms (rotation of the contact forces, change of branches and volume) are included, so C is
// the result of a probe, not a material stiffness; it is unsymmetric in general.
#pragma once

#include <Eigen/Core>

#include "rvelab/solver/assembly/network.hpp"

namespace rvelab {

/// All degrees of freedom of the grains condensed: each grain keeps its force and torque balance while the cell
/// strains. Rattlers (see measures.hpp) and their contacts are excluded. Free mechanisms (spins without stiffness, the
/// uniform translation) carry no load and have no effect. If Hertz-Mindlin contacts rescale their tangential force on
/// unloading, the response is piecewise linear; the mean of the plus and the minus direction is returned (the limit of
/// small probes; probes of 1e-7 differ by 7e-6). Cost: one sparse LU, 4 ms for 400 discs and 0.4 s for 1000 spheres
/// (tools/bench/tangent). Throws Error if the residual exceeds 1e-6 of the load and the unbalanced ratio of the state.
Eigen::MatrixXd elastic_tangent(const Network& network);

/// All grains move with the strain without rotation: the affine stiffness of solver/README.md plus initial-stress
/// terms, over all contacts. Stiffer than the condensed tangent (1.15 to 1.35 times for disordered packings): a
/// preconditioner.
Eigen::MatrixXd affine_tangent(const Network& network);

}  // namespace rvelab
