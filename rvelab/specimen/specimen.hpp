// A specimen: the complete state from which an Rve is opened and that determines its next bit. A plain value: importers
// and packers make it, Rve::specimen() returns it. Its parts are aggregates; specimen_fields.hpp describes each member.
#pragma once

#include <cstdint>
#include <vector>

#include "rvelab/cell/cell.hpp"
#include "rvelab/contact/model.hpp"
#include "rvelab/grains/own_columns.hpp"
#include "rvelab/grains/rigid_motion.hpp"
#include "rvelab/grains/shape.hpp"
#include "rvelab/interaction/interaction.hpp"
#include "rvelab/solver/assembly/list_state.hpp"
#include "rvelab/solver/loading/loading_state.hpp"
#include "rvelab/solver/quasi_static/control_state.hpp"
#include "rvelab/solver/state/reference.hpp"

namespace rvelab {

/// Grains, one entry each, in the order of their ids. Vectors are in the cell frame; in 2D z-components of position
/// and velocity, and x and y of the spin, are zero. The columns of its shape come before all others.
struct Grains : OwnColumns<List> {
  std::vector<std::int64_t> id;
  std::vector<double> radius;          ///< m; of a shape that is not round that of the disc of its area
  std::vector<std::int32_t> material;  ///< index into Specimen::materials
  std::vector<Vector3> position;       ///< m
  std::vector<Vector3> velocity;       ///< m/s, fluctuation v' (at the last half step); quasi-static: m per sub-step
  std::vector<Vector3> spin;           ///< rad/s, fluctuation w'; quasi-static: rad per sub-step
  std::vector<Vector3> orientation;    ///< not round: along the long axis, of length 1; else empty
  std::size_t size() const { return id.size(); }
};

/// One touching pair with its history. i and j index Grains, i <= j; the branch is x_j + L image - x_i. Ordered by
/// (i, j, image). Force and moment are those on grain j, cell frame.
struct Contact {
  std::int32_t i = 0, j = 0;
  Image image{};
  /// N, spring part (without dashpot). 2D: (f_t, 0, 0) with f_t along t = (-n_y, n_x), invariant under rotation.
  Vector3 tangential_force = Vector3::Zero();
  Vector3 rolling_moment = Vector3::Zero();  ///< N m
  double last_root_overlap = 0;  ///< what k_t went with at the last step, m^0.5 (hertz_mindlin: sqrt(delta))
};

/// A rigid body (clump): some grains that follow each other in Grains and move as one. Contacts are those of its
/// members; mass and inertia are those of their union, of the material of its members. Vectors are in the cell frame.
struct Body {
  std::int64_t id = 0;
  std::int32_t first = 0;              ///< row of its first member in Grains; its last is before the next body's first
  Vector3 position = Vector3::Zero();  ///< m, centre of gravity
  Vector3 velocity = Vector3::Zero();  ///< as that of grains
  Vector3 spin = Vector3::Zero();  ///< as that of grains; at a rate that of the angular momentum at the last half step
  Turn orientation;                ///< principal axes to cell frame; in the plane about z
  double volume = 0;               ///< m^3, of the union
  Vector3 gyration = Vector3::Zero();  ///< m^2, principal moments of inertia over the mass, ascending; in the plane all
                                       ///< three that about z
};

/// Position of a grain in its body.
struct BodyMember {
  Vector3 offset = Vector3::Zero();  ///< m, from the centre of gravity along the principal axes
};

/// Upper limit of solver.skin: a wider list has hundreds of pairs per grain without any use.
inline constexpr double largest_skin_ratio = 10;

/// Settings of the solver.
struct SolverOptions {
  double skin = 0.15;                ///< largest Verlet skin over the mean radius, > 0; adapted at run time
  double time_step_factor = 0.7;     ///< fraction of the critical step 2/omega_max, 0 < f < 1
  double fixed_time_step = 0;        ///< s; > 0: loading at a rate uses equal steps, at most this long
  long collision_steps = 100;        ///< at a rate: sub-steps of a collision where collisions carry the energy; 0: the
                                     ///< critical step alone (collisions.hpp)
  double relative_tolerance = 1e-2;  ///< quasi-static: error of an increment over max(|d sigma|, 0.1 |C : d eps|)
  double absolute_tolerance = 1e-4;  ///< quasi-static: added to that, over the pressure
  double target_unbalanced = 0;  ///< quasi-static: if > 0, determines the number of sub-steps instead of the tolerances
  long fixed_substeps = 0;  ///< quasi-static: if > 0, number of sub-steps of each increment of strain, no error control
  long max_substeps = 50'000'000;   ///< an increment that needs more fails
  double min_height = 0;            ///< m; shortest lattice vector allowed; 0: 2 r_max
  double max_overlap_ratio = 0.25;  ///< largest overlap over the smaller radius; more fails
  bool energy_balance = false;      ///< compute the energy balance (cost: tools/bench)
};

/// State beside grains, contacts and cell that determines the next bit, by the part of the solver that owns it.
struct SolverState {
  ListState list;
  LastStep last_step;
  ScaledMasses masses;
  QuasiStaticControl control;
  ServoState servo;
  Reference reference;
  std::uint64_t grain_steps = 0;           ///< grains times sub-steps made so far
  std::vector<std::int32_t> memory_order;  ///< large assemblies: index into Grains by row in memory (memory_order.hpp)
  EnergyTerms energy_balance;
};

/// Interactions other than contacts (bonds), and the parameters from which they form (water), come before its members.
struct Specimen : Interactions {
  Shape shape = round_shape(3);
  Cell cell;
  std::vector<Material> materials;
  ContactModel contact;
  Damping damping;
  SolverOptions solver;
  Grains grains;
  std::vector<Body> bodies;         ///< empty: every grain moves by itself; otherwise all grains are members
  std::vector<BodyMember> members;  ///< one for each grain if there are bodies
  std::vector<Contact> contacts;
  SolverState state;
};

}  // namespace rvelab
