// The stable step: bounds on stiffness and damping of each grain, the critical time step with physical masses, and the
// scaled masses of quasi-static loading.
//
// The energy of a contact, kn (n.(u_j - u_i))^2/2 + kt (t.(u_j - u_i) - a_i theta_i - a_j theta_j)^2/2 + kr
// (theta_j - theta_i)^2/2, is at most the sum of terms that belong to one grain each: 2 kn (n.u)^2, 4 kt (t.u)^2 and
// 4 kt a^2 theta^2 + 2 kr theta^2 for each of the two (Cauchy-Schwarz: the block form of Gershgorin's row sums). So
// omega_max^2 <= the largest row sum over inertia, for translation and rotation alike.
#pragma once

#include "rvelab/solver/assembly/assembly.hpp"

namespace rvelab {

struct RowSums {
  std::vector<double> translation;  ///< N/m
  std::vector<double> rotation;     ///< N m
  std::vector<double> dashpot;      ///< N s/m, the same bound for the dashpots; empty without
  double floor_translation = 0;     ///< what a grain of two median contacts has; every grain counts as at least that
  double floor_rotation = 0;        ///< over r^2, N/m
};

RowSums row_sums(const Model& model, const Assembly& assembly);

/// Smallest 2/omega_max over the grains with physical masses (dashpots included: 2/omega (sqrt(1 + zeta^2) - zeta)), s;
/// infinite without contacts.
double critical_step(const Model& model, const RowSums& sums);

/// The sums with every grain at least at the floor, so that a contact about to form finds a step that is safe for it.
RowSums with_floor(RowSums sums, const Model& model);

/// Masses and inertias such that a unit step is `factor` times the critical one for every grain.
void scale_inertia(const Model& model, const RowSums& sums, Assembly& assembly);

/// Least row sum of translation behind the scaled masses, N/m: that of a grain of two typical contacts, where one has
/// no more of them.
double least_stiffness(const Model& model, const Assembly& assembly);

void use_physical_inertia(const Model& model, Assembly& assembly);

}  // namespace rvelab
