// Stress measures of finite strain, and the tangent of each with respect to its conjugate strain.
#pragma once

#include <vector>

#include "tools/umat/kinematics.hpp"

namespace umat {

/// Cauchy stress; second and first Piola-Kirchhoff stress, S = J F^-1 sigma F^-T and P = J sigma F^-T.
enum class StressMeasure { cauchy, second_piola, first_piola };

Matrix3 from_cauchy(StressMeasure measure, const Matrix3& sigma, const Matrix3& F);
Matrix3 to_cauchy(StressMeasure measure, const Matrix3& stress, const Matrix3& F);

/// d sigma/dF; dS/dE with E = (F^T F - I)/2; dP/dF; d(J sigma)/dL with F1 = L F0.
enum class TangentKind { cauchy_gradient, second_piola_green_lagrange, first_piola_gradient, kirchhoff_increment };

/// Components of tensors of a host in the plane (2) or in space (3): symmetric ones 11 22 33 12 13 23, their shear
/// times sqrt(2); others 11 22 33 12 21 13 31 23 32.
int symmetric_components(int dimension);
int all_components(int dimension);
Matrix3 symmetric_tensor(const double* from, int dimension);
Matrix3 any_tensor(const double* from, int dimension);
void write_symmetric(const Matrix3& tensor, int dimension, double* to);
void write_any(const Matrix3& tensor, int dimension, double* to);

/// The tangent in the rows and columns of the host, row by row, of a material whose Cauchy stress follows `tangent`
/// (order of hosts, engineering shear) at zero spin and rotates with the spin. F0 and F1: start and end of the step,
/// sigma and tangent: at its end.
std::vector<double> finite_strain_tangent(TangentKind kind, const Matrix6& tangent, const Matrix3& sigma,
                                          const Matrix3& F0, const Matrix3& F1, int dimension);

/// d sigma/d eps, rows and columns symmetric components.
std::vector<double> small_strain_tangent(const Matrix6& tangent, int dimension);

/// The largest n_i m_j C_ijkl n_k m_l over unit vectors: density times the square of the speed of the fastest wave, Pa.
double wave_modulus(const Matrix6& tangent);

}  // namespace umat
