// Deviators of tensors in the plane or in space, and the angle between the axes of two of them.
#pragma once

#include "rvelab/cell/cell.hpp"
#include "rvelab/solver/assembly/network.hpp"

namespace rvelab {

/// I; of the plane alone in 2D.
Matrix3 identity_in(int dimension);

/// Symmetric deviator. In 2D out-of-plane components are left out.
Matrix3 deviator(const Matrix3& tensor, int dimension);

/// Cell frame to laboratory.
inline Matrix3 in_laboratory(const Network& network, const Matrix3& tensor) {
  return network.cell.rotation * tensor * network.cell.rotation.transpose();
}

/// Acute angle between the axes of the largest eigenvalues of two tensors (symmetrised; 2D: in the plane), degrees, 0
/// to 90: the non-coaxiality of stress (compression positive) and fabric or strain increment. NaN if one of them has no
/// single such axis: isotropic, or in 3D two equal largest eigenvalues (triaxial extension).
double axes_angle_deg(const Matrix3& one, const Matrix3& other, int dimension);

}  // namespace rvelab
