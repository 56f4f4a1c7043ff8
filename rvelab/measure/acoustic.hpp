// The acoustic tensor of a stiffness, and the band that it allows (Rudnicki and Rice 1975; Rice 1976).
//
//   Q_ik(n) = n_j C_ijkl n_l
// A band with the normal n may form if det Q(n) <= 0. C is d(Cauchy stress)/d(strain) as given by elastic_tangent() and
// probe_stiffness(); terms of the order of the stress, by its rotation, are neglected against the stiffness. For a
// plastic material with the angles phi and psi in the plane the first band has cos 2 theta = -(sin phi + sin psi)/2,
// theta between its normal and the major stress (Vardoulakis 1980): 45 + phi/2 to 45 + psi/2.
#pragma once

#include <Eigen/Core>

#include "rvelab/cell/cell.hpp"

namespace rvelab {

/// d x d, Pa. `stiffness`: 3 x 3 in the order xx yy xy, or 6 x 6, xx yy zz yz xz xy. `normal`: of length 1.
Eigen::MatrixXd acoustic_tensor(const Eigen::MatrixXd& stiffness, const Vector3& normal);

/// The direction of the least det Q.
struct Band {
  double determinant = 0;  ///< Pa^d
  Vector3 normal;          ///< of length 1, first component that is not zero positive
  double mean = 0;         ///< of det Q over all directions
};
Band weakest_band(const Eigen::MatrixXd& stiffness);

/// Acute angle between the normal of a band and the major principal axis of a stress (tension positive, laboratory
/// frame), degrees: the inclination of the band to the plane on which the major stress acts. NaN without such an axis.
double band_angle_deg(const Band& band, const Matrix3& stress, int dimension);

}  // namespace rvelab
