// The periodic cell: lattice matrix, frame, deformation, wrapping, reduction.
//
// This module contains only geometry: no grains, contacts, forces or time.
//
// Conventions. The columns of the lattice matrix L are the cell vectors a, b, c; L is upper triangular with positive
// diagonal and is written in the cell frame. The rotation Q maps cell-frame vectors to the laboratory frame:
// v_lab = Q v_cell, sigma_lab = Q sigma_cell Q^T. In 2D the third cell vector is (0, 0, thickness): it carries the
// volume and is never periodic, deformed or reduced. All lengths in m. (Qu, Feng and Wang, eq. 1-9.)
#pragma once

#include <Eigen/Core>
#include <array>

namespace rvelab {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using Image = std::array<int, 3>;  ///< integer coordinates of a lattice translation L n

/// A periodic cell and its frame.
struct Cell {
  int dimension = 3;                       ///< 2 (slab of thickness L_zz) or 3
  Matrix3 lattice = Matrix3::Identity();   ///< m, upper triangular, positive diagonal, cell frame
  Matrix3 rotation = Matrix3::Identity();  ///< Q, cell frame to laboratory
  long increments = 0;                     ///< increments since Q was last renormalised

  double volume() const;  ///< m^3, product of the diagonal
};

/// One increment of displacement gradient, split in the cell frame: Q^T (I + dH) Q = R U. This is the QR decomposition,
/// not the polar one: U is upper triangular, so that the lattice stays so, and R is not the rotation of the polar one.
struct FrameSplit {
  Matrix3 rotation;  ///< R, proper rotation; the new frame is Q R
  Matrix3 stretch;   ///< U, upper triangular, positive diagonal; the new lattice is U L
  bool rigid;        ///< max |U - I| <= 8 eps: only the frame changes
};

/// Splits F_inc = I + dH (laboratory frame, finite, dimensionless). Throws InvalidIncrement if an entry is not
/// finite, if det(I + dH) <= 0, or, in 2D, if a z-component exceeds 1e-12 + 1e-9 max|dH|.
FrameSplit split_increment(const Cell& cell, const Matrix3& displacement_gradient);

/// The displacement gradient dH (dimensionless) with an isotropic stretch on top, in the plane in 2D, such that
/// det(I + dH) = `ratio` to round-off. Throws InvalidIncrement if det(I + dH) <= 0. `ratio` > 0, of order one.
Matrix3 with_volume_ratio(const Matrix3& displacement_gradient, double ratio, int dimension);

/// Rotates the frame by R and counts the increment; every 100th one renormalises Q by one Newton step.
void turn_frame(Cell& cell, const Matrix3& frame_rotation);

/// Newton step towards the nearest orthogonal matrix: Q <- Q (3 I - Q^T Q) / 2.
Matrix3 renormalised(const Matrix3& rotation);

/// Brings a point into the primary cuboid (-L_ii/2, L_ii/2), z first, then y, then x (2D: y, then x), by lattice
/// vectors. Returns w with x_new = x_old + L w.
Image wrap(const Cell& cell, Vector3& position);

/// L n for an integer translation n.
Vector3 translation(const Cell& cell, const Image& image);

/// Perpendicular distances between opposite faces of the parallelepiped, m (2D: third entry infinite).
Vector3 heights(const Cell& cell);

/// Length of the shortest non-zero lattice vector, m. In 2D only a and b count.
double shortest_vector(const Cell& cell);

/// The least simple shear v_i(x_k), in either direction, at which a height of the reduced cell is below `least_height`
/// (m); infinite if no shear up to `most` does this. A cell with a vector along i never becomes thin.
double shear_until_thin(const Cell& cell, int i, int k, double least_height, double most);

/// A change of basis: L_new = R^T L N with N unimodular (det +1). Every stored cell-frame vector v becomes R^T v, an
/// image n becomes N^-1 n, and the frame Q becomes Q R.
struct Reduction {
  Eigen::Matrix3i basis = Eigen::Matrix3i::Identity();          ///< N
  Eigen::Matrix3i inverse_basis = Eigen::Matrix3i::Identity();  ///< N^-1
  Matrix3 rotation = Matrix3::Identity();                       ///< R
  Matrix3 lattice = Matrix3::Identity();                        ///< the reduced lattice
  bool changed = false;  ///< false: the basis is already reduced (to the tolerance)
};

/// Full reduction of the lattice: Lagrange-Gauss in 2D, a Minkowski-reduced basis in 3D, with a relative tolerance
/// (ties at one half would swap for ever) and an iteration cap.
Reduction reduced(const Cell& cell);

/// Applies a reduction to lattice and frame.
void apply_reduction(Cell& cell, const Reduction& reduction);

/// M = R U with R a proper rotation and U upper triangular.
struct TriangularFactors {
  Matrix3 rotation;  ///< R, det +1
  Matrix3 upper;     ///< U; entries below the diagonal are exactly zero
};

/// Factors M (any unit). The first two diagonal entries of U are positive, the third has the sign of det M; a
/// singular M gives a zero, negative or NaN diagonal entry, which the caller checks. Only + - * / sqrt are used. Only
/// a nonzero entry below the diagonal or a negative diagonal entry causes a rotation: an upper triangular M with
/// positive diagonal is unchanged with R = I, a signed permutation is exact, and a matrix with z-components (0, 0, m)
/// keeps them. (Golub and Van Loan, Matrix Computations, section 5.1.8.)
TriangularFactors triangular_factors(const Matrix3& matrix);

/// Square (2D) or simple cubic (3D) cell of the given volume (m^3), axes along the laboratory's.
Cell cubic_cell(int dimension, double volume, double thickness = 1.0);

/// 2D cell of the given volume whose lattice repeats under planar pure shear with principal axes x and y: the square
/// lattice turned by the Kraynik-Reinelt angle (31.72 degrees). (Kraynik and Reinelt 1992.)
Cell kraynik_reinelt_cell(double volume, double thickness);

/// 3D cell for diagonal (uniaxial, triaxial) flows along the laboratory axes: the lattice of the totally real cubic
/// field of discriminant 49 (roots of x^3 + x^2 - 2x - 1), scaled to the given volume.
Cell cubic_field_cell(double volume);

/// p = -tr(sigma)/d, Pa, compression positive.
inline double mean_pressure(const Matrix3& stress, int dimension) {
  return -(stress(0, 0) + stress(1, 1) + (dimension == 3 ? stress(2, 2) : 0.0)) / dimension;
}

}  // namespace rvelab
