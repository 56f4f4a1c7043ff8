// Measures of a contact network: stress, fabric, coordination, void ratio, sliding, energies, dimensionless numbers.
//
// This module reads a Network (or tensors) and changes nothing; it is independent of lists, steps and files. The
// network is in the cell frame; returned tensors are in the laboratory frame. SI units; stress is Cauchy, tension
// positive; p and q are compression positive as in soil mechanics. 2D: volumes are those of the slab, tensors have zero
// z-components. The mean of an empty set (fabric without a contact, void ratio without a grain) is NaN.
#pragma once

#include <vector>

#include "rvelab/cell/cell.hpp"
#include "rvelab/solver/assembly/network.hpp"

namespace rvelab {

/// Stress of the forces of contacts and interactions, Pa: -(1/V) sum F (x) b, sigma_kl with force component k, branch
/// component l; F is the force on j, b the branch from i to j (Love-Weber). Not symmetrised: the antisymmetric part
/// measures unbalanced torque.
Matrix3 contact_stress(const Network& network);

/// Part of it carried by bonds, water or adhesion.
Matrix3 interaction_stress(const Network& network, Family family);

/// Stress of the velocity fluctuations, Pa: -(1/V) sum m v' (x) v'. Zero for a quasi-static network.
Matrix3 reynolds_stress(const Network& network);

/// q, Pa, of the symmetric deviator s: 2D sqrt(s:s/2), 3D sqrt(3 s:s/2).
double deviatoric_stress(const Matrix3& stress, int dimension);

/// eps_q of the symmetric deviator e: 2D sqrt(2 e:e), 3D sqrt(2 e:e/3). Also for rates.
double deviatoric_strain(const Matrix3& strain, int dimension);

/// <n (x) n> over all contacts; trace 1. n differs from the branch direction for grains that are not round.
Matrix3 fabric(const Network& network);

/// sum b (x) b / sum b.b over all contacts: fabric weighted with the squared branch length; trace 1.
Matrix3 branch_fabric(const Network& network);

/// Mean of e (x) e over all grains, e along the long axis; trace 1. NaN where the grains are round.
Matrix3 orientation_fabric(const Network& network);

/// Fa of a fabric tensor of trace 1. 2D: F = 4 (phi - I/2), sqrt(F:F/2), the a of E(theta) = (1 + a cos 2(theta -
/// theta_a))/2pi; 3D: F = 15/2 (phi - I/3), sqrt(3 F:F/2).
double fabric_anisotropy(const Matrix3& fabric, int dimension);

/// Number of contacts of each grain; a contact with its own image counts twice.
std::vector<int> contact_counts(const Network& network);

/// Grains without load: fewer than two contacts, in 2D and 3D, removed repeatedly with their contacts (Thornton 2000
/// removes once). Two opposite contacts can hold a grain by friction, a single one cannot.
std::vector<bool> rattlers(const Network& network);

/// Z = 2 Nc/N, all grains counted.
double coordination_number(const Network& network);

/// 2 Np/N, Np touching pairs of grains. Several contacts of two bodies count once.
double touching_neighbours(const Network& network);

/// Z_mech = 2 Nc/N without rattlers and their contacts.
double mechanical_coordination_number(const Network& network);

/// e = (V - Vs)/Vs, overlaps not subtracted, all grains counted.
double void_ratio(const Network& network);

/// The same with rattlers counted as voids.
double mechanical_void_ratio(const Network& network);

/// Fraction of contacts with |f_t| >= (1 - 1e-6) mu |f_n|; with mu = 0 all slide. Zero without contacts.
double sliding_fraction(const Network& network);

/// Mean resultant over all grains / max(mean contact force, 1e-3 of the reference force). Zero where both vanish.
double unbalanced_force_ratio(const Network& network);

/// The same of torques over the radius, N: mean |torque|/r over all grains / the same scale. What
/// an Rve reports as its unbalanced ratio is the larger of the two.
double unbalanced_torque_ratio(const Network& network);

/// Energy stored in contacts, J: normal, tangential and rolling springs.
double elastic_energy(const Network& network);
/// Volume of the cell minus that of the grains, m^3; overlaps not subtracted.
double pore_volume(const Network& network);

/// sum m v'^2/2 + I w^2/2, J, with w the whole spin, as the energy balance counts it (with w' alone the balance of a
/// shear at 300 to 1000 per s would miss 0.5 to 9 % of the work). Zero for a quasi-static network.
double kinetic_energy(const Network& network);

/// Largest overlap over the smaller radius of its pair; zero without contacts.
double largest_overlap_ratio(const Network& network);

/// Number mean of the grain diameters, m; twice the radius, which is that of the disc of its area.
double mean_diameter(const Network& network);

/// Mass over solid volume of all grains, kg/m^3.
double solid_density(const Network& network);

/// I = sqrt(2 e:e) d sqrt(rho/p) with e the symmetric deviator of the velocity gradient (1/s), d the mean diameter (m),
/// rho the density of the solid (kg/m^3), p the mean pressure (Pa). Infinite at p <= 0 under strain; zero without.
double inertial_number(const Matrix3& velocity_gradient, int dimension, double diameter, double density,
                       double pressure);

}  // namespace rvelab
