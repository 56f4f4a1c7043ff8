// The grain assembly in the layout of the step kernels: one row per grain, one force row per listed pair, CSR gather.
// Opened from a Specimen and written back to one. Everything here is a plain copyable value; a failed increment is
// undone by its trial (trial.hpp).
#pragma once

#include <atomic>
#include <vector>

#include "rvelab/solver/assembly/bodies.hpp"
#include "rvelab/solver/assembly/buffer.hpp"
#include "rvelab/solver/assembly/neighbour_list.hpp"
#include "rvelab/solver/kernels/configuration.hpp"
#include "rvelab/specimen/specimen.hpp"
#include "rvelab/threads/pieces.hpp"

namespace rvelab {

struct StepTimes;

/// What an increment never changes.
struct Model {
  Shape shape = round_shape(2);
  std::vector<Material> materials;
  ContactModel contact;
  Damping damping;
  SolverOptions options;
  InteractionSettings interaction_settings;
  SharedArray<std::int64_t> id;
  SharedArray<std::int32_t> material;
  SharedArray<double> radius, mass, inertia;    ///< m, kg, kg m^2 (physical)
  std::shared_ptr<const BodyModel> bodies;      ///< null: every grain moves by itself
  OwnColumns<SharedArray> own;                  ///< of the shape
  SharedArray<double> outer_radius;             ///< not round: of the circles around the grains, m
  SharedArray<double> turn_first, turn_second;  ///< not round: TurnValues for the grain loop, padded to lanes
  /// Superellipsoids: what does not change in their rows, nine each (columns 3 and 16 to 23).
  SharedArray<double> form;
  bool ellipsoids = false;       ///< superellipsoids with exponents of 2 alone
  double mean_radius = 0;        ///< m; of bodies where there are some
  double largest_reach = 0;      ///< m, of the circles around the grains
  double largest_skin = 0;       ///< m
  double min_height = 0;         ///< m
  Kernels kernels;               ///< as the specimen states them, at a rate
  Kernels quasi_static_kernels;  ///< without the dashpot, whose time a sub-step of quasi-static loading is not
  /// 1 without rolling stiffness; sqrt(4 kt r^2/(4 kt r^2 + 2 kr)) of typical grains: how much slower than the contacts
  /// grains answer that slip about a stiff rolling spring, once their inertia is scaled for that spring.
  double slip_frequency_ratio = 1;
  /// Factor on the constraint ratio at rest where contacts roll: a rolling spring counts by grip_of(rolling friction),
  /// not by grip_of(friction), since one that yields at once holds as little as a contact of little friction.
  double rolling_constraint_factor = 1;
  /// Grains of one size of all materials have contacts of one stiffness, within a factor of ten.
  bool alike_contacts = true;
  double hardening = 1;                     ///< d ln f_n/d ln overlap of typical grains: 1 linear, 3/2 Hertz
  double thickness = 0;                     ///< m, 2D
  const std::atomic<bool>* stop = nullptr;  ///< true: advance throws Interrupted (Rve::watch)
  Workers* team = nullptr;                  ///< shares the steps of a large assembly (Rve::share)
  StepTimes* times = nullptr;               ///< the time of each part is added here (Rve::measure_time)

  std::size_t size() const { return id.size(); }
  /// The team where the assembly is large enough for one, else null.
  Workers* sharing() const { return size() >= least_shared_grains ? team : nullptr; }
  const Kernels& kernels_at(Loading loading) const {
    return loading == Loading::quasi_static ? quasi_static_kernels : kernels;
  }
  bool radius_from_curvature() const { return contact.hertz_radius == HertzRadius::curvature; }
  /// Whether contacts keep sqrt(overlap) of the last sub-step.
  bool stores_root_overlap() const {
    return with_law(contact.law, [](auto law) { return decltype(law)::Force::stores_root_overlap; });
  }
  int dimension() const { return dimension_of(shape); }
  int row_length() const { return row_length_of(shape); }
  bool round() const { return is_round(shape); }
  int velocity_offset() const { return dimension() == 2 ? 2 : 4; }
  int tangential_components() const { return dimension() == 2 ? 1 : 3; }
  /// Radii of the circles (spheres) around the grains, by which they are listed, m.
  const std::vector<double>& reach() const { return round() ? radius : outer_radius; }
  Extent extent_of(std::size_t g) const { return rvelab::extent_of(shape, radius[g], own, g); }
  double volume_of(std::size_t g) const { return grain_volume(shape, radius[g], thickness); }
  /// Of a member its share of the body: 1 and the radius of grains that move by themselves.
  double share_of(std::size_t g) const { return bodies ? bodies->share[g] : 1; }
  double size_of(std::size_t g) const { return bodies ? bodies->radius[std::size_t(bodies->owner[g])] : radius[g]; }
  /// m^3, of a member its share.
  double solid_of(std::size_t g) const {
    return bodies ? bodies->share[g] * bodies->volume[std::size_t(bodies->owner[g])] : volume_of(g);
  }
  /// kg, that a contact of the grain moves.
  double moved_mass(std::size_t g) const { return bodies ? bodies->mass[std::size_t(bodies->owner[g])] : mass[g]; }
  double inertia_of(std::size_t g, double of_mass) const {
    return moment_of_inertia(shape, of_mass, radius[g], own_of(shape, own, g));
  }
};

/// Interactions of one kind other than contacts, as arrays; padded to a multiple of eight. In the order of (i, j,
/// image), which is that of every sum over them.
struct InteractionTable {
  int kind = 0;           ///< of InteractionLaws
  std::size_t count = 0;  ///< without the padding
  std::vector<std::int32_t> i, j;
  std::vector<Image> image;
  std::vector<Buffer> column;  ///< as the law numbers them
  // What follows from these, the grains and the pairs.
  std::vector<std::int32_t> row_i, row_j;
  std::vector<Buffer> image_number, radius;  ///< three, and those of i and of j
  std::size_t row_at = 0;                    ///< the first of its force rows in PairTable

  std::size_t padded() const { return i.size(); }
};

/// Listed pairs with their parameters and history, as arrays; padded to a multiple of eight. Those that touched when
/// they were listed stand first, so that the kernels can pass over the others. Every sum over pairs goes by `order`:
/// what touched then, and with it the index of a pair, is not preserved by a restart.
struct PairTable {
  std::size_t listed = 0;           ///< pairs without the padding
  std::size_t near = 0;             ///< the first of them, computed at every step (kernels/configuration.hpp)
  std::vector<std::int32_t> order;  ///< indices of the pairs in the order of (i, j, image)
  /// kernels/configuration.hpp. Sums over pairs pass over what has not touched: forces must be those of the positions
  /// that the grains have.
  std::vector<std::uint8_t> touched, shifted;
  std::vector<std::int32_t> i, j;
  std::vector<std::int32_t> row_i, row_j;  ///< i, j times the length of a grain row
  std::vector<Image> image;
  Buffer image_number[3];
  Buffer kn, kt, law_constant, friction, kr, moment_cap, cn;
  Buffer tangential[3], moment[3], root_overlap, force;
  Buffer radius_i, radius_j;  ///< where the kernels read them by pairs
  Buffer solid, directions;   ///< superellipsoids (kernels/configuration.hpp): torques; directions, which are no state
  std::vector<std::int32_t> slot_begin, slots;  ///< gather table (kernels/configuration.hpp)
  std::vector<std::uint16_t> tasks;
  /// `slots` as the grain loop reads them: those of pairs beyond `near` point to a padding pair until one of their
  /// eight touches, since a row of zeros need not be fetched to be added (32,000 spheres with 2.5 contacts and 3.5
  /// listed pairs each: the grain loop takes 0.75 of the time; 1000: 0.98). And where the slots of those pairs are, two
  /// each.
  std::vector<std::int32_t> gathered, slots_beyond;
  /// Interactions other than contacts, by kind, those that there are: their force rows stand behind those of the pairs.
  std::vector<InteractionTable> interactions;
  Buffer resultants;  ///< what they give to the grains (kernels/configuration.hpp); empty without them
  Buffer on_members;  ///< what the members of bodies get from their pairs (BodyArrays::resultants)

  std::size_t padded() const { return i.size(); }
  /// Of a pair, or of an interaction by its row (InteractionTable::row_at).
  const double* force_row(int dimension, std::size_t p) const {
    return force.data() + std::size_t(force_row_length(dimension)) * p;
  }
};

/// Bytes that its arrays take.
std::size_t bytes_of(const PairTable& pairs);

/// What a trial began with and what seldom changes in one (trial.hpp): put here when something else takes its place.
struct Replaced {
  PairTable list;
  std::vector<Vector3> list_positions;  ///< ListState::positions
  bool list_taken = false;
  Buffer mass, inverse_mass, inverse_inertia;
  bool masses_taken = false;
};

/// Where a pending trial puts what is replaced; a copy of the assembly has no trial.
struct TrialLink {
  Replaced* replaced = nullptr;
  TrialLink() = default;
  TrialLink(const TrialLink&) noexcept {}
  TrialLink& operator=(const TrialLink&) noexcept {
    replaced = nullptr;
    return *this;
  }
};

/// What an increment changes.
struct Assembly {
  Cell cell;
  Buffer rows;                                 ///< padded grain rows (kernels/configuration.hpp)
  Buffer mass, inverse_mass, inverse_inertia;  ///< those in use: physical, or scaled in quasi-static loading
  PairTable pairs;
  BodyMotions bodies;  ///< empty without
  SolverState state;
  TrialLink trial;

  Vector3 position(const Model& model, std::size_t g) const;
  Vector3 velocity(const Model& model, std::size_t g) const;  ///< fluctuation, in the units of the mode in use
  Vector3 spin(const Model& model, std::size_t g) const;
  Vector3 orientation(const Model& model, std::size_t g) const;  ///< of a grain that keeps an axis
  void set_velocity(const Model& model, std::size_t g, const Vector3& v, const Vector3& w);
};

/// Puts into a grain row what does not move but turn with the grain, from the axis that stands there
/// (kernels/configuration.hpp).
void complete_row(const Model& model, std::size_t g, double* row);

/// Room for n grains or pairs in whole blocks of lanes, at least one padding entry.
constexpr std::size_t padded_to_lanes(std::size_t n) { return (n / 8 + 1) * 8; }

/// Checks a specimen and opens it; from some size on its grains are kept in an order of their own (memory_order.hpp),
/// in which every index of Model and Assembly counts. Throws InputError.
void open_assembly(const Specimen& specimen, Model& model, Assembly& assembly);
Specimen close_assembly(const Model& model, const Assembly& assembly);

/// Throws IncrementFailed if the shortest lattice vector is below min_height.
void check_height(const Model& model, const Cell& cell);

/// Reduces the lattice where needed, wraps the grains, lists anew, carries history over. Returns the reduction made.
/// Throws IncrementFailed if the shortest lattice vector is below min_height, or if the list would be too long.
Reduction rebuild(const Model& model, Assembly& assembly);

/// Gap up to which every pair is listed, m, whenever the list was made: what lies between depends on the list.
double listed_gap(const Model& model, const Assembly& assembly);

/// Whether a pair that is not listed might touch by now. May tighten the bound that the state keeps on displacements.
/// `margin` (m): asks already while grains are that far from touching, so that those in flight are listed before they
/// do.
bool list_is_stale(const Model& model, Assembly& assembly, double margin = 0);

/// What follows from list and model, made anew: parameters, indices as the kernels want them; force rows are zero.
/// The gather table belongs to the list. Pairs not computed at every step must have no history unless they touch.
void derive_pairs(const Model& model, PairTable& pairs);

/// Pair parameters from the materials, for all listed pairs (after listing, or when materials change).
void set_pair_parameters(const Model& model, PairTable& pairs);

/// Force rows from the stored history; nothing advances.
void evaluate_forces(const Model& model, Assembly& assembly);

PairArrays arrays_of(PairTable& pairs);
GrainArrays arrays_of(const Model& model, Assembly& assembly);

/// Constants that do not change from step to step, filled in; lattice from the cell, rate and step from the state.
StepConstants base_constants(const Model& model, const Assembly& assembly);

/// Inverse of an upper-triangular matrix, by hand: it is taken several times a sub-step.
Matrix3 upper_inverse(const Matrix3& matrix);
UpperTriangle upper_triangle(const Matrix3& matrix);
/// Velocity gradient of the cell (upper triangular, 1/s) and the mean spin that goes with it.
void set_rate(const Matrix3& rate, StepConstants& constants);

/// Sum of f (x) b over contacts, f the force on j, b the branch from i to j: minus the stress times the volume, N m.
/// Cell frame, from force rows and present positions.
Matrix3 contact_virial(const Model& model, const Assembly& assembly);

/// Contact force on j of listed pair p as last computed, N.
Vector3 force_of(const Model& model, const PairTable& pairs, std::size_t p);

/// Resultant of a grain's contacts, cell frame.
struct Resultant {
  Vector3 force = Vector3::Zero(), torque = Vector3::Zero();  ///< N, N m
};
std::vector<Resultant> resultants_of(const Model& model, const Assembly& assembly);

/// What force and torque each grain is left with, and the mean and largest figures that control needs.
struct OutOfBalance {
  double mean_resultant = 0;      ///< N, |force| over all grains
  double mean_couple = 0;         ///< N, |torque| over the radius
  double mean_contact_force = 0;  ///< N, over touching contacts; 0 without any
  std::size_t touching = 0;
  double largest_overlap_ratio = 0;  ///< overlap over the smaller radius
  double mean_overlap = 0;           ///< m
  bool finite = true;
};
OutOfBalance balance_of(const Model& model, const Assembly& assembly);
/// The larger of the two means over the mean contact force: a ratio of forces alone does not see grains that still turn
/// (rolling stiffness 1e3 to 1e6: the stress was wrong by 2 to 12 % of p at a ratio of 1e-3).
double unbalanced_ratio(const OutOfBalance& balance, double reference_contact_force);
/// Throws IncrementFailed if a value is not finite or an overlap is beyond the limit.
void check_overlaps(const Model& model, const OutOfBalance& balance);

}  // namespace rvelab
