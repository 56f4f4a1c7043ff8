// The contact network as a value, from which measures are taken. Made by Rve::network(); no pointer into the solver.
#pragma once

#include <vector>

#include "rvelab/specimen/specimen.hpp"

namespace rvelab {

/// One touching contact (overlap > 0) as the solver sees it now. Cell frame. Forces and moments are those on grain j.
struct ContactState {
  std::int32_t i = 0, j = 0;
  Image image{};
  Vector3 branch;                   ///< x_j + L image - x_i, m
  Vector3 normal;                   ///< from i to j; branch / length where the grains are round
  Vector3 arm_i, arm_j;             ///< from the centres to the contact point, m
  double length = 0;                ///< m
  double overlap = 0;               ///< m, > 0
  double normal_force = 0;          ///< N, repulsion positive, dashpot included
  double pressing_force = 0;        ///< N, what friction goes with: |f_t| <= friction |pressing_force|
  Vector3 tangential_force;         ///< N, on j, dashpot included
  Vector3 rolling_moment;           ///< N m, on j
  double normal_stiffness = 0;      ///< d f_n/d overlap now, N/m
  double tangential_stiffness = 0;  ///< k_t now, N/m
  double rolling_stiffness = 0;     ///< k_r now, N m
  double stiffness_growth = 0;      ///< d ln k_t/d overlap, 1/m, where the law carries f_t by k_t (unload_rescale)
  double friction = 0;              ///< mu
  double moment_cap = 0;            ///< |M| <= moment_cap pressing_force, m
  double elastic_energy = 0;        ///< J, normal + tangential + rolling
  // Of bodies (clumps), whose numbers i and j are; branch, arms and image are those from centre to centre of gravity.
  std::int32_t member_i = -1, member_j = -1;                       ///< the members that touch; -1 without bodies
  Vector3 member_branch = Vector3::Zero();                         ///< m, from member to member
  Vector3 offset_i = Vector3::Zero(), offset_j = Vector3::Zero();  ///< m, from the bodies' centres to the members'
  Vector3 force() const { return normal_force * normal + tangential_force; }  ///< on j, N
};

/// An interaction other than a contact that acts now (an intact bond). The point halves the gap, overlap is minus the
/// gap and may have either sign; rolling_moment and rolling_stiffness are those of bending.
struct InteractionState : ContactState {
  int kind = 0;                   ///< of InteractionLaws
  double twisting_moment = 0;     ///< N m, on j about the normal
  double twisting_stiffness = 0;  ///< N m
};

struct GrainState : OwnValues {
  double radius = 0, mass = 0, inertia = 0;  ///< m, kg, kg m^2
  Vector3 position, velocity, spin;          ///< cell frame; fluctuation velocity and spin, physical (at a rate)
  Vector3 resultant;                         ///< sum of the forces of contacts and interactions, N
  Vector3 torque = Vector3::Zero();          ///< sum of their torques, moments included, N m
  Vector3 orientation = Vector3::Zero();     ///< not round: along the long axis, cell frame
};

struct Network {
  Shape shape = round_shape(3);
  Cell cell;
  ContactModel model;
  std::vector<GrainState> grains;      ///< where there are bodies (clumps), those: round ones of the same volume
  std::vector<GrainState> members;     ///< then: the grains that they are made of
  std::vector<std::int32_t> owner;     ///< by member
  std::vector<Matrix3> moments;        ///< by body: tensor of inertia, kg m^2, cell frame
  std::vector<Matrix3> axes;           ///< by body: principal axes as columns, cell frame
  std::vector<ContactState> contacts;  ///< ordered by (i, j, image)
  std::vector<InteractionState> interactions;  ///< kind by kind, each ordered by (i, j, image)
  double reference_contact_force = 0;          ///< N, floor of the unbalanced ratio is 1e-3 of it
  double reference_pressure = 0;               ///< Pa
  Vector3 mean_spin = Vector3::Zero();         ///< axial(W + Omega) of the cell, rad/s, zero in quasi-static loading: a
                                               ///< grain's whole spin is this and its fluctuation
  Loading loading = Loading::quasi_static;     ///< quasi-static velocities carry scaled masses: no kinetic stress
  int dimension() const { return cell.dimension; }
  /// Bodies of one grain each that has a shape of its own, whose axes are those of the shape.
  bool has_solids() const { return moves_as_body(shape); }
  bool has_bodies() const { return !members.empty(); }
  /// What is drawn: discs, spheres, ellipses.
  const std::vector<GrainState>& drawn() const { return has_bodies() ? members : grains; }
};

}  // namespace rvelab
