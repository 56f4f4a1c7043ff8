// A specimen: everything that an Rve is opened from and that decides its next bit. A plain value: importers and packers
// make it, Rve::specimen() returns it. Its parts are aggregates; specimen_fields.hpp describes each of their members.
#pragma once

#include <cstdint>
#include <vector>

#include "rvelab/cell/cell.hpp"
#include "rvelab/contact/model.hpp"
#include "rvelab/grains/own_columns.hpp"
#include "rvelab/grains/shape.hpp"

namespace rvelab {

/// Grains, one entry each, in the order of their ids. Vectors are in the cell frame; in 2D z-components of position
/// and velocity, and x and y of the spin, are zero. The columns of its shape stand before all others.
struct Grains : OwnColumns<List> {
  std::vector<std::int64_t> id;
  std::vector<double> radius;          ///< m; of a shape that is not round that of the disc of its area
  std::vector<std::int32_t> material;  ///< index into Specimen::materials
  std::vector<Vector3> position;       ///< m
  std::vector<Vector3> velocity;       ///< m/s, fluctuation v' (at the last half step); dt = 0: m per sub-step
  std::vector<Vector3> spin;           ///< rad/s, fluctuation w'; dt = 0: rad per sub-step
  std::vector<Vector3> orientation;    ///< not round: along the long axis, of length 1; else empty
  std::size_t size() const { return id.size(); }
};

/// One touching pair with its history. i and j index Grains, i <= j; the branch is x_j + L image - x_i. Ordered by
/// (i, j, image). Force and moment are those on grain j, cell frame.
struct Contact {
  std::int32_t i = 0, j = 0;
  Image image{};
  /// N, spring part (without dashpot). 2D: (f_t, 0, 0) with f_t along t = (-n_y, n_x), which no rotation changes.
  Vector3 tangential_force = Vector3::Zero();
  Vector3 rolling_moment = Vector3::Zero();  ///< N m
  double last_root_overlap = 0;              ///< sqrt(delta) at the last step, m^0.5 (hertz_mindlin)
};

/// solver.skin at most: a wider list holds hundreds of pairs a grain and serves nothing.
inline constexpr double largest_skin_ratio = 10;

/// Settings of the solver.
struct SolverOptions {
  double skin = 0.15;                ///< largest Verlet skin over the mean radius, > 0; adapted at run time
  double time_step_factor = 0.7;     ///< fraction of the critical step 2/omega_max, 0 < f < 1
  double fixed_time_step = 0;        ///< s; > 0: dt > 0 loading uses equal steps, at most this long
  long collision_steps = 100;        ///< dt > 0: sub-steps of a collision where collisions carry the energy; 0: the
                                     ///< critical step alone (collisions.hpp)
  double relative_tolerance = 1e-2;  ///< dt = 0: error of an increment over max(|d sigma|, 0.1 |C : d eps|)
  double absolute_tolerance = 1e-4;  ///< dt = 0: added to that, over the pressure
  double target_unbalanced = 0;      ///< dt = 0: if > 0, determines the number of sub-steps instead of the tolerances
  long fixed_substeps = 0;  ///< dt = 0: if > 0, number of sub-steps of each increment of strain, no error control
  long max_substeps = 50'000'000;   ///< an increment that needs more fails
  double min_height = 0;            ///< m; shortest lattice vector allowed; 0: 2 r_max
  double max_overlap_ratio = 0.25;  ///< largest overlap over the smaller radius; more fails
  bool energy_balance = false;      ///< compute the energy balance (cost: tools/bench)
};

/// Energy balance, J, sums since the specimen was first opened (solver/README.md). Zero if it is not computed.
struct EnergyTerms {
  double boundary_work = 0;
  double friction = 0, rolling = 0, dashpot = 0;
  double local_damping = 0, global_damping = 0;
  double law_loss = 0;         ///< change of f_t^2/2kt at varying kt (Hertz-Mindlin), and M^2/2kr
  double removed_kinetic = 0;  ///< kinetic energy removed when scaled masses change or the mean velocity is taken out
};

/// Solver state that decides the next bit, beside grains, contacts and cell.
struct SolverState {
  bool has_reference = false;              ///< the next five tell when the neighbour list must be rebuilt
  Matrix3 list_lattice = Matrix3::Zero();  ///< lattice when the list was built, m
  std::vector<Vector3> list_positions;     ///< positions then, m, cell frame; empty: only the bound below is used.
                                           ///< Not round: z says how the long axis lay (oriented_bounds.hpp)
  double list_travel = 0;                  ///< bound on the largest displacement since then beside the cell's, m
  double list_skin = 0;                    ///< skin that the list was built with, m; 0: solver.skin
  std::int64_t list_steps = 0;             ///< sub-steps made since then
  double strain_per_step = 0;              ///< dt = 0: strain increment per sub-step; 0: not yet known
  double target_unbalanced_ratio = 0;      ///< dt = 0: unbalanced ratio for which it was chosen
  double strain_since_reversal = 0;        ///< dt = 0: strain since the last reversal, up to a limit
  double network_stiffness_ratio =
      1;                        ///< dt = 0: stiffness ratio |d sigma|/|C : d eps| of the last interval (accuracy.hpp)
  double constraint_ratio = 0;  ///< dt = 0: constraints of the contacts over the degrees of freedom of the
                                ///< grains that have any, when the interval began; 0: not known
  double measured_error_factor = 0;     ///< dt = 0: K of the last relaxation of a copy (accuracy.hpp); 0: not known
  double strain_since_measurement = 0;  ///< dt = 0: strain since then
  std::int64_t steps_since_measurement = 0;        ///< dt = 0: sub-steps since then
  std::int64_t steps_at_fixed_shape = 0;           ///< dt = 0: sub-steps since the cell last changed its shape
  double network_stiffness = 0;                    ///< dt = 0: |C : d eps|/strain when it began, Pa
  double interval_strain = 0;                      ///< dt = 0: strain in the present interval
  Matrix3 interval_stress = Matrix3::Zero();       ///< dt = 0: stress when it began, cell frame, Pa
  double unbalanced_ratio = 0;                     ///< dt = 0: at the last equilibrium check
  Matrix3 deferred_stretch = Matrix3::Identity();  ///< dt = 0: deferred to the next sub-step; cell frame
  Matrix3 stress_slope =
      Matrix3::Zero();     ///< dt = 0: change of stress over the norm of the strain, last increment, cell frame, Pa
  double slope_error = 0;  ///< dt = 0: twice the error of this slope at the next increments, fading by 0.7, Pa
  std::int64_t steps_since_scaling = -1;       ///< dt = 0: sub-steps since masses were scaled; < 0: they are not
  std::vector<double> scaled_mass;             ///< dt = 0: masses in use, N/m (the sub-step is 1); empty: to be scaled
  std::vector<double> scaled_inverse_inertia;  ///< the same: 1 over the moments of inertia, 1/(N m)
  Matrix3 servo_strain =
      Matrix3::Zero();                   ///< mixed targets: integral term, strain per unit of driving strain, lab frame
  Matrix3 servo_rate = Matrix3::Zero();  ///< dt > 0: rate of strain of its last update, 1/s, lab frame
  double reference_contact_force = 0;    ///< N, mean contact force when first opened; 0: set on opening
  double reference_overlap = 0;          ///< m, mean overlap when first opened; 0: set on opening
  double reference_pressure = 0;         ///< Pa, p when first opened; 0: set on opening
  bool quasi_static = true;              ///< units of the stored velocities (see Grains)
  Matrix3 last_rate = Matrix3::Zero();   ///< D of the last sub-step, cell frame (dashpot forces need it)
  double last_step = 0;                  ///< length of the last sub-step: s, or 1 at dt = 0
  Vector3 mean_velocity = Vector3::Zero();  ///< mass-weighted mean v' that the next step takes out
  Vector3 mean_spin = Vector3::Zero();      ///< axial(W + Omega) of the last sub-step, rad/s (dt > 0)
  std::uint64_t grain_steps = 0;            ///< grains times sub-steps made so far
  std::uint64_t list_builds = 0;
  std::vector<std::int32_t>
      memory_order;  ///< large assemblies: index into Grains by place in memory (memory_order.hpp)
  EnergyTerms energy_balance;
};

struct Specimen {
  Shape shape = round_shape(3);
  Cell cell;
  std::vector<Material> materials;
  ContactModel contact;
  Damping damping;
  SolverOptions solver;
  Grains grains;
  std::vector<Contact> contacts;
  SolverState state;
};

}  // namespace rvelab
