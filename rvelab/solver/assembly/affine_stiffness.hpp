// Stiffness of the contact network if every grain followed the cell: C = (1/V) sum l^2 [kn nnnn + kt (...)]
// (solver/README.md). 1.15 to 1.35 times too stiff as an elastic modulus, which makes it a safe gain for the servo and
// a preconditioner.
#pragma once

#include <Eigen/Core>

#include "rvelab/solver/assembly/assembly.hpp"

namespace rvelab {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// d sigma / d eps, Pa, laboratory frame, order xx yy zz yz xz xy, engineering shear. Initial-stress terms left out.
Matrix6 affine_stiffness(const Model& model, const Assembly& assembly);

/// d sigma / d (rate of eps) of the contact dashpots, Pa s, in the same form; zero without.
Matrix6 affine_viscosity(const Model& model, const Assembly& assembly);

/// Symmetric matrix from strain components xx yy zz yz xz xy (engineering shear), and back.
Matrix3 strain_matrix(const Vector6& components);
Vector6 strain_components(const Matrix3& symmetric);

}  // namespace rvelab
