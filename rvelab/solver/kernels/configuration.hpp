// What a step kernel is compiled for (its configuration) and what it is handed (plain pointers and constants). The
// kernels themselves include no Eigen and no containers, so this header holds none.
//
// A configuration is shape x law x rolling x slip convention x dashpot x Hertz's radius. It is chosen once, when an Rve
// is opened; the loops hold no branch over it.
#pragma once

#include <cstdint>

#include "rvelab/contact/kinds.hpp"
#include "rvelab/contact/laws.hpp"
#include "rvelab/grains/shape.hpp"
#include "rvelab/interaction/laws.hpp"

namespace rvelab {

struct KernelConfiguration {
  Shape shape = round_shape(2);
  Law law = Law::linear;
  bool rolling = false;
  Slip slip = Slip::consistent;
  bool dashpot = false;
  HertzRadius hertz_radius = HertzRadius::equivalent;
  bool ellipsoids = false;  ///< superellipsoids with exponents of 2 alone
};

/// Upper-triangular 3x3 matrix, in the order xx, xy, xz, yy, yz, zz.
struct UpperTriangle {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
};

/// Energies of one call, J: dissipation between two evaluations of the contact forces.
struct Dissipation {
  double friction = 0, rolling = 0, dashpot = 0, law_loss = 0;
};

/// Doubles of the force row of a pair (PairArrays::force).
constexpr int force_row_length(int dimension) { return dimension == 2 ? 4 : 8; }

/// Constants of one sub-step (all in the cell frame).
struct StepConstants {
  double dt = 0;                 ///< s; 1 in quasi-static loading
  UpperTriangle lattice;         ///< L at the end of the step
  UpperTriangle rate;            ///< D+ = (L1 - L0)/dt L1^-1: branch velocity = dv' + D+ (b - dt/2 dv')
  double spin[3] = {};           ///< axial vector of skew D, at mid-step
  UpperTriangle map;             ///< A = L1 L0^-1
  UpperTriangle velocity_map;    ///< dt B, B = L_mid L0^-1: x1 = A x0 + dt B v'
  double momentum_map[9] = {};   ///< P = (I + dt/2 G)^-1 (I - dt/2 G), G = D + 2 Omega (at a rate only)
  double force_map[9] = {};      ///< (I + dt/2 G)^-1
  double spin_map[9] = {};       ///< the same rotation for spins, Omega only (3D, at a rate)
  double spin_shift[3] = {};     ///< added to w' each step (at a rate): minus the change of axial(W + Omega)
  double mean_velocity[3] = {};  ///< taken out of v' at the start of the step
  double local_damping = 0;
  double global_viscous = 0;    ///< N s/m
  double tangential_ratio = 0;  ///< tangential over normal dashpot
  int dashpot_quarters = 0;     ///< power of the overlap in the dashpot coefficient, in quarters
  Slip slip = Slip::consistent;
  bool ellipsoids = false;  ///< as KernelConfiguration has it
  bool no_tension = false;
  bool unload_rescale = true;
  bool losses = false;  ///< at a rate: sums of what the dampings take are asked for
};

/// Form of local damping; the grain loops are compiled for each.
enum class KernelDamping { none, vector, component };

/// Listed pairs, padded with pairs that never touch to a multiple of eight. The first `near` of them touched when they
/// were listed, or so; they are computed at every step. The others seldom come to touch: eight at a time they are only
/// checked, until one does (next_run in kernels/pairs.hpp).
struct PairArrays {
  long near = 0;                        ///< a multiple of eight
  std::uint8_t* touched = nullptr;      ///< by eight pairs: whether one touched when they were computed last
  const std::int32_t* row_i = nullptr;  ///< where the row of grain i starts among the doubles of the grain rows
  const std::int32_t* row_j = nullptr;
  const double* image[3] = {};  ///< image shift, as numbers
  const double *kn = nullptr, *kt = nullptr, *friction = nullptr;
  const double* law_constant = nullptr;                   ///< laws with a constant of their own
  const double *kr = nullptr, *moment_cap = nullptr;      ///< with rolling
  const double* cn = nullptr;                             ///< with a dashpot
  double* tangential[3] = {};                             ///< history on grain j; 2D: [0] along t = (-n_y, n_x)
  double* moment[3] = {};                                 ///< with rolling; 2D: [0] about z
  double* root_overlap = nullptr;                         ///< laws that carry what k_t went with
  const double *radius_i = nullptr, *radius_j = nullptr;  ///< where the kernels read them by pairs
  double* force = nullptr;  ///< row per pair: 2D {fx, fy, T_j, T_i}; 3D {fx, fy, fz, delta/2, n x f_t, 0},
                            ///< superellipsoids {fx, fy, fz, 0, T_j, 0}
  const std::uint8_t* shifted = nullptr;  ///< by eight pairs: whether one is with an image, else all shifts are 0
  /// Superellipsoids: row of eight a pair {-, -, -, -, torque on i (N m), 0}, found by the slots of the force rows.
  /// With rows of four, found by half a slot, ellipsoids took 1,676 instead of 1,646 instructions a grain-step, the
  /// same time.
  double* solid = nullptr;
  double* directions = nullptr;  ///< superellipsoids: row of eight a pair, no state: {where the contact is looked for
                                 ///< first, 0, its direction the last time, 0}, zeros where there is none
};

/// Grains that are gathered and integrated together: their resultants stay in the first-level cache between.
constexpr long chunk_grains = 64;

/// Grain rows: discs 8 doubles {x, y, u, v, w, 0, 0, 0}; spheres 12, {x, y, z, r, u, v, w, 0, wx, wy, wz, r}; shapes
/// that are not round {x, y, u, v, w, ex, ey, l, ...} with e along the long axis and l = Extent::turning, and then
/// shape-specific numbers (ellipses.hpp). Padded to a multiple of eight with grains of no extent and infinite mass, at
/// least one of them.
struct GrainArrays {
  double* rows = nullptr;
  const double *mass = nullptr, *inverse_mass = nullptr, *inverse_inertia = nullptr;
  /// Gather table. Grain g of a chunk has two tasks: the sum of the force rows where it is j, and of those where it is
  /// i. The tasks of a chunk, sorted by their number of pairs, form blocks of four lanes. Lane k of block b adds the
  /// force rows that begin at slots[4 s + k], s = slot_begin[b] to slot_begin[b + 1] - 1; a lane that runs out reads a
  /// padding pair, whose force is zero, and so do pairs that have not touched since they were listed
  /// (PairTable::gathered). tasks[4 b + k] is where the sum goes: 4 g as j, 4 (chunk_grains + g) as i. Loop lengths are
  /// seldom mispredicted so (against blocks of four neighbouring grains: spheres 32.6 ns a grain instead of 35.7, discs
  /// equal).
  const std::int32_t *slot_begin = nullptr, *slots = nullptr;
  const std::uint16_t* tasks = nullptr;
  const double *turn_first = nullptr, *turn_second = nullptr;  ///< not round: TurnValues (grains/description.hpp)
  bool rolling = false;                                        ///< in space the moments of pairs are gathered too
  /// What interactions other than contacts give to each grain, as long as grain rows, or null: in the plane {fx, fy, T,
  /// ...}, in space {fx, fy, fz, -, T, -, ...}. The grain loop takes them: it leaves zeros for the next sub-step.
  double* resultants = nullptr;
  /// Called before a chunk is gathered, with the end of the chunk, where pairs are updated just in time
  /// (loading/sweep.hpp).
  void (*before_chunk)(void* sweep, long end) = nullptr;
  void* sweep = nullptr;
};

/// Doubles of a body: {x, y, z, 0, u, v, w, 0, wx, wy, wz, 0, q0, q1, q2, q3}, q its orientation.
constexpr int body_row_length = 16;

/// Rigid bodies and their members, which are grains (assembly/bodies.hpp); both padded to a multiple of eight, bodies
/// with such as have no members, members with those of such a body.
struct BodyArrays {
  double* motion = nullptr;             ///< rows
  double* turning = nullptr;            ///< rows of four: spin of the last turn in the cell frame; 2D: [0] alone
  const std::int32_t* first = nullptr;  ///< member of each body, and the end
  const double *mass = nullptr, *inverse_mass = nullptr, *inverse_inertia = nullptr;  ///< those in use
  const double *moments[3] = {}, *inverse_moments[3] = {};                            ///< physical, principal axes
  // By member.
  const std::int32_t* row_of_owner = nullptr;  ///< where the row of its body starts
  const double* offset[3] = {};                ///< body frame
  double* arm[3] = {};                         ///< cell frame
  const double* image[3] = {};                 ///< as numbers
  double* resultants = nullptr;  ///< of its contacts, about the centre of the body; 2D {fx, fy, T, -}, 3D {f, -, T, -}
};

/// Constants of one sub-step beside StepConstants (loading/body_motion.hpp).
struct BodyConstants {
  KernelDamping damping = KernelDamping::none;
  UpperTriangle inverse_stretch, gradient;             ///< B^-1 and G
  double mean_spin_before[3] = {}, mean_spin[3] = {};  ///< axial(W + Omega) of the sub-step before and of this one
  bool frame_turns = false;                            ///< at a rate in 3D
  double frame_back[4] = {1, 0, 0, 0};                 ///< quaternion of StepConstants::spin_map
};

/// Sums that the integration leaves behind: momentum (kg m/s), largest |v'|^2 (not round: (|v'| + l |w|)^2, as fast
/// as their bounds can move), energy taken by local and global damping.
struct StepSums {
  double momentum[3] = {};
  double largest_speed_squared = 0;
  double local_damping = 0, global_damping = 0;
};

using PairKernel = void (*)(const StepConstants&, const PairArrays&, const double* grain_rows, long begin, long end,
                            Dissipation*);
using GrainKernel = void (*)(const StepConstants&, const GrainArrays&, const PairArrays&, long begin, long end,
                             StepSums*);

/// Of the members [begin, end), as the gather table has its chunks: force and torque of their contacts.
using MemberForces = void (*)(const GrainArrays&, const PairArrays&, const BodyArrays&, long begin, long end);
/// Of the bodies, or of the members, [begin, end), multiples of eight; members have a largest speed alone.
using BodyKernel = void (*)(const StepConstants&, const BodyConstants&, const BodyArrays&, double* grain_rows,
                            long begin, long end, StepSums*);

/// Doubles that a kernel of places writes for a pair: n_x, n_y, and in m overlap (< 0: apart by that or more), h_i,
/// h_j, torques of a force of 1 along n on i and on j (kernels/ellipses.hpp), 0; in space n, overlap, contact point
/// from the centre of i, 0 (kernels/superellipsoids.hpp).
constexpr int place_row_length = 8;
/// Of the pairs [begin, end), multiples of eight; pair p goes to places + 8 p. Reads rows, images and, of the
/// constants, the lattice.
using PlaceKernel = void (*)(const StepConstants&, const PairArrays&, const double* grain_rows, long begin, long end,
                             double* places);

/// Of the interactions [begin, end) of one kind, multiples of eight.
using InteractionKernel = void (*)(const StepConstants&, const InteractionArrays&, const double* grain_rows, long begin,
                                   long end);

/// The compiled kernels of one configuration.
struct Kernels {
  PairKernel pairs = nullptr;              ///< contact forces with their increments
  PairKernel pairs_with_losses = nullptr;  ///< the same, with dissipation (scalar)
  PairKernel evaluate = nullptr;           ///< contact forces of the stored history, nothing advanced (scalar)
  PlaceKernel places = nullptr;            ///< shapes that are not round: where pairs are, for sums outside the loops
  GrainKernel quasi_static[3] = {};        ///< by KernelDamping
  GrainKernel at_rate[3] = {};
  // Bodies: clumps of round grains, and superellipsoids, which are placed as they move.
  MemberForces gather_on_members = nullptr;
  BodyKernel move_bodies[2] = {};  ///< quasi-static, at a rate
  BodyKernel place_members = nullptr;
  /// By the kind of interaction (interaction/laws.hpp), round grains: as `pairs` and `evaluate`.
  InteractionKernel interactions[interaction_kinds] = {};
  InteractionKernel evaluate_interactions[interaction_kinds] = {};
  int lanes = 1;
  const char* instruction_set = "scalar";
};

/// Kernels for a configuration: the widest that processor and build offer, or what the environment variable RVELAB_ISA
/// names (scalar, baseline, v3, v4; InputError if it cannot run here). Every choice gives the same bits. What is
/// compiled for the scalar reference alone (step_kernels.hpp) is taken from there.
Kernels kernels_for(const KernelConfiguration& key);

}  // namespace rvelab
