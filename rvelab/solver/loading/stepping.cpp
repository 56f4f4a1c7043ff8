#include "rvelab/solver/loading/stepping.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "rvelab/error.hpp"
#include "rvelab/solver/assembly/gather_table.hpp"
#include "rvelab/solver/assembly/interactions.hpp"
#include "rvelab/solver/assembly/released_energy.hpp"
#include "rvelab/solver/loading/body_motion.hpp"
#include "rvelab/solver/loading/collisions.hpp"
#include "rvelab/solver/loading/inertia.hpp"
#include "rvelab/solver/loading/step_times.hpp"
#include "rvelab/solver/loading/strain_path.hpp"
#include "rvelab/solver/loading/sweep.hpp"

namespace rvelab {

namespace {

Vector3 axial(const Matrix3& m) {
  return {0.5 * (m(2, 1) - m(1, 2)), 0.5 * (m(0, 2) - m(2, 0)), 0.5 * (m(1, 0) - m(0, 1))};
}

Matrix3 cross_matrix(const Vector3& w) {
  Matrix3 m;
  m << 0, -w[2], w[1], w[2], 0, -w[0], -w[1], w[0], 0;
  return m;
}

void copy_rows(const Matrix3& m, double* to) {
  for (int r = 0; r < 3; ++r)
    for (int k = 0; k < 3; ++k) to[3 * r + k] = m(r, k);
}

/// The straight path of the lattice still to go, and the turn of the frame at its end.
struct LatticePath {
  Matrix3 start, target;
  Matrix3 end_rotation;
  long done = 0, steps = 1;

  Matrix3 lattice_after(long k) const {
    return k == steps ? target : Matrix3(start + (double(k) / double(steps)) * (target - start));
  }
};

/// After a change of basis the rest of the path is split anew in the new frame; its end is the same cell. Returns the
/// rotation by which the new frame turns more than the old one over that rest.
Matrix3 turn_path(LatticePath& path, const Matrix3& lattice_before, const Reduction& reduction, const Cell& cell) {
  const Matrix3 rest = path.target * upper_inverse(lattice_before);
  const Matrix3& r = reduction.rotation;
  Cell plain = cell;
  plain.rotation.setIdentity();
  const FrameSplit split = split_increment(plain, r.transpose() * rest * r - Matrix3::Identity());
  path.end_rotation = r.transpose() * path.end_rotation * r * split.rotation;
  path.start = cell.lattice;
  path.target = split.stretch * cell.lattice;
  path.steps -= path.done;
  path.done = 0;
  return split.rotation;
}

/// Rate-dependent constants of a step from L0 to L1, with the frame turning at `omega` (rad/s, cell frame).
void set_step(const Matrix3& l0, const Matrix3& l1, double dt, StepConstants& c, Matrix3& rate_end, Matrix3& rate_mid) {
  const Matrix3 change = (l1 - l0) / dt;
  rate_end = change * upper_inverse(l1);
  const Matrix3 middle = 0.5 * (l0 + l1);
  rate_mid = change * upper_inverse(middle);
  const Matrix3 inverse_start = upper_inverse(l0);
  c.dt = dt;
  c.lattice = upper_triangle(l1);
  set_rate(rate_end, c);
  c.map = upper_triangle(l1 * inverse_start);
  c.velocity_map = upper_triangle(dt * (middle * inverse_start));
}

/// Maps of velocity and spin at a rate (solver/README.md, equations of motion): dv'/dt = f/m - (D + 2 Omega) v', dw/dt
/// = T/I with w = w' + axial(W + Omega) held in axes that turn with Omega.
void set_frame_terms(const Matrix3& rate_mid, const Vector3& omega, const Vector3& mean_spin_change, StepConstants& c) {
  const Matrix3 identity = Matrix3::Identity();
  const Matrix3 g = rate_mid + 2 * cross_matrix(omega);
  const Matrix3 inverse = (identity + 0.5 * c.dt * g).inverse();
  copy_rows(inverse * (identity - 0.5 * c.dt * g), c.momentum_map);
  copy_rows(inverse, c.force_map);
  const Matrix3 turn = cross_matrix(omega);
  const Matrix3 back = (identity + 0.5 * c.dt * turn).inverse() * (identity - 0.5 * c.dt * turn);
  copy_rows(back, c.spin_map);
  const Vector3 shift = -mean_spin_change - c.dt * omega.cross(axial(rate_mid));
  for (int k = 0; k < 3; ++k) c.spin_shift[k] = shift[k];
}

KernelDamping damping_kind(const Damping& d, Loading loading) {
  const double alpha = loading == Loading::at_rate ? d.local : d.local_quasi_static;
  if (alpha == 0) return KernelDamping::none;
  return d.local_form == LocalDampingForm::vector ? KernelDamping::vector : KernelDamping::component;
}

/// Books one sub-step; `moment_before` is the contacts' moment at its start, and becomes that at its end.
void book_step(const Model& model, Assembly& assembly, const Dissipation& lost, const StepSums& sums, double step,
               bool physical, const Matrix3& gradient, Matrix3& moment_before) {
  EnergyTerms& booked = assembly.state.energy_balance;
  const Matrix3 moment = contact_virial(model, assembly);
  // V sigma = -sum F (x) b - sum m v' v'; the contact part by the trapezium, the kinetic one at the half step.
  Matrix3 work = -0.5 * (moment_before + moment);
  if (physical) work += reynolds_stress_times_volume(model, assembly);
  booked.boundary_work += step * work.cwiseProduct(gradient).sum();
  booked.friction += lost.friction;
  booked.rolling += lost.rolling;
  booked.dashpot += lost.dashpot;
  booked.law_loss += lost.law_loss;
  booked.local_damping += sums.local_damping;
  booked.global_damping += sums.global_damping;
  moment_before = moment;
}

/// Velocities are those of the half step behind. Where the step changes that half step does too: v' <- v' + (dt_old -
/// dt_new)/2 f/m (and w'), without which a Hertz impact gains 2 % of its energy from the steps that it asks for.
/// Changes of less than a hundredth are let be.
void shift_half_step(const Model& model, Assembly& assembly, double step) {
  const double shift = 0.5 * (assembly.state.last_step.length - step);
  if (model.options.fixed_time_step > 0 || !(assembly.state.last_step.length > 0) ||
      std::abs(shift) < 0.005 * assembly.state.last_step.length)
    return;
  if (model.bodies) {
    shift_bodies(model, shift, assembly);
    assembly.state.last_step.length = step;
    return;
  }
  const std::vector<Resultant> resultants = resultants_of(model, assembly);
  for (std::size_t g = 0; g < model.size(); ++g)
    assembly.set_velocity(model, g,
                          assembly.velocity(model, g) + shift * assembly.inverse_mass[g] * resultants[g].force,
                          assembly.spin(model, g) + shift * assembly.inverse_inertia[g] * resultants[g].torque);
  assembly.state.last_step.length = step;
}

/// Divides the sub-steps that are left, so that the collisions that a new list shows are followed.
void divide_rest(const Model& model, const Collisions& ahead, Assembly& assembly, LatticePath& path, double& step) {
  if (!(ahead.step < step)) return;
  const double parts = std::ceil(step / ahead.step), left = double(path.steps - path.done) * parts;
  if (left > double(model.options.max_substeps))
    throw IncrementFailed("collisions in the increment need sub-steps of " + in_words(step / parts) +
                          " s; solver.max_substeps = " + std::to_string(model.options.max_substeps) +
                          " allows none so short; apply it in smaller parts or lower solver.collision_steps");
  path.start = assembly.cell.lattice;
  path.steps = long(left);
  path.done = 0;
  step /= parts;
  shift_half_step(model, assembly, step);
}

/// The sub-steps of one Advance.
class SubSteps {
 public:
  SubSteps(const Model& model, Assembly& assembly, const Advance& what);
  Advanced make();

 private:
  /// Cell and constants of the next sub-step.
  void move_cell();
  void move_grains();
  void move_bodies_of_step();
  void take_list();
  /// Lists the pairs anew; where the lattice is reduced, what is held in its frame turns with it.
  void list_pairs_anew();
  void turn_with(const Reduction& reduction, const Matrix3& lattice_before);
  void update_pairs();
  /// Whether the pairs may wait for the grains of the next sub-step, where nothing asks for forces before. A sub-step
  /// that is timed has both apart.
  bool can_wait(bool forces_asked, long made) const;
  /// At a rate: what the new list shows of collisions to come.
  void look_ahead();

  const Model& model_;
  Assembly& assembly_;
  const Advance& what_;
  const bool at_rate_;
  const Kernels& kernels_;
  const GrainKernel move_;
  Workers* const team_;
  StepConstants c_;
  LatticePath path_;
  Vector3 omega_ = Vector3::Zero();  ///< rate at which the frame turns, rad/s, cell frame
  double step_, total_mass_ = 0;
  long check_every_;
  PairArrays pairs_;
  GrainArrays grains_;
  StepSums sums_;
  BodySweep bodies_;
  const bool in_one_sweep_;
  WaitingPairs waiting_;
  ReleasedEnergy released_;
  Matrix3 rate_end_, rate_mid_, moment_before_ = Matrix3::Zero();
  Matrix3 lattice_before_ = Matrix3::Identity();  ///< of the step; bodies alone
  Vector3 mean_spin_before_ = Vector3::Zero();
  StepClock clock_;
};

GrainKernel grain_kernel(const Model& model, const Assembly& assembly, Loading loading) {
  const auto kind = std::size_t(damping_kind(model.damping, loading));
  const Kernels& kernels = model.kernels_at(assembly.state.last_step.loading);
  const GrainKernel chosen = loading == Loading::at_rate ? kernels.at_rate[kind] : kernels.quasi_static[kind];
  if (chosen == nullptr && !model.bodies)
    throw InputError("this build has no kernels of loading at a rate; use the program");
  return chosen;
}

SubSteps::SubSteps(const Model& model, Assembly& assembly, const Advance& what)
    : model_(model),
      assembly_(assembly),
      what_(what),
      at_rate_(what.loading == Loading::at_rate),
      kernels_(model_.kernels_at(assembly_.state.last_step.loading)),
      move_(grain_kernel(model_, assembly_, what.loading)),
      team_(model_.sharing()),
      c_(base_constants(model_, assembly_)),
      path_{assembly_.cell.lattice, what.increment.stretch * assembly_.cell.lattice, what.increment.rotation, 0,
            what.steps},
      step_(what.step),
      check_every_(what.check_every),
      bodies_(model_, assembly_, at_rate_, damping_kind(model_.damping, what.loading)),
      in_one_sweep_(model_.size() >= least_grains_in_one_sweep && !model_.options.energy_balance &&
                    !has_interactions(assembly_) && !model_.bodies && (team_ == nullptr || team_->count() == 1)),
      clock_(model_.times) {
  c_.losses = model_.options.energy_balance;
  c_.local_damping = at_rate_ ? model_.damping.local : what.damping * model_.damping.local_quasi_static;
  if (at_rate_) {
    shift_half_step(model_, assembly_, step_);
    omega_ = rotation_vector(what.increment.rotation) / (step_ * double(what.steps));
  }
  total_mass_ = std::accumulate(assembly_.mass.begin(), assembly_.mass.begin() + std::ptrdiff_t(model_.size()), 0.0);
  take_list();
  if (model_.options.energy_balance) moment_before_ = contact_virial(model_, assembly_);
}

void SubSteps::move_cell() {
  const Matrix3 before = assembly_.cell.lattice;
  assembly_.cell.lattice = path_.lattice_after(++path_.done);
  set_step(before, assembly_.cell.lattice, step_, c_, rate_end_, rate_mid_);
  for (int k = 0; k < 3; ++k) c_.mean_velocity[k] = assembly_.state.last_step.mean_velocity[k];
  lattice_before_ = before;
  if (!at_rate_) return;
  mean_spin_before_ = assembly_.state.last_step.mean_spin;
  const Vector3 mean_spin = axial(rate_mid_) + omega_;
  set_frame_terms(rate_mid_, omega_, mean_spin - assembly_.state.last_step.mean_spin, c_);
  assembly_.state.last_step.mean_spin = mean_spin;
}

void SubSteps::move_grains() {
  clock_.begin_grains();
  if (model_.bodies)
    move_bodies_of_step();
  else if (waiting_.any())
    waiting_.sweep_with_grains(move_, c_, grains_, pairs_, long(assembly_.mass.size()), sums_);
  else
    sweep_grains(move_, c_, grains_, pairs_, long(assembly_.mass.size()), team_, sums_);
  clock_.end_grains();
  // The rows that pad the lanes lose the mean velocity too, step after step; their speed must never count.
  std::fill(assembly_.rows.begin() + std::ptrdiff_t(model_.size()) * model_.row_length(), assembly_.rows.end(), 0.0);
  for (int k = 0; k < 3; ++k) assembly_.state.last_step.mean_velocity[k] = sums_.momentum[k] / total_mass_;
  ++assembly_.state.list.steps;
  assembly_.state.last_step.rate = rate_end_;
  assembly_.state.last_step.length = step_;
}

void SubSteps::move_bodies_of_step() {
  const Matrix3& after = assembly_.cell.lattice;
  const Matrix3 middle = 0.5 * (lattice_before_ + after), inverse_stretch = lattice_before_ * upper_inverse(middle);
  const Matrix3 gradient = inverse_stretch * ((after - lattice_before_) / step_) * upper_inverse(lattice_before_);
  bodies_.set_step(c_, inverse_stretch, gradient, mean_spin_before_, assembly_.state.last_step.mean_spin);
  bodies_.move(c_, grains_, pairs_, assembly_, sums_);
}

void SubSteps::take_list() {
  pairs_ = arrays_of(assembly_.pairs);
  grains_ = arrays_of(model_, assembly_);
  if (in_one_sweep_) waiting_.arrange(kernels_.pairs, assembly_.pairs);
}

void SubSteps::list_pairs_anew() {
  clock_.begin_list();
  const Matrix3 lattice_before = assembly_.cell.lattice;
  const Reduction reduction = rebuild(model_, assembly_);
  if (reduction.changed) turn_with(reduction, lattice_before);
  take_list();
  clock_.end_list();
}

void SubSteps::turn_with(const Reduction& reduction, const Matrix3& lattice_before) {
  const Matrix3 more = turn_path(path_, lattice_before, reduction, assembly_.cell);
  omega_ = reduction.rotation.transpose() * omega_;
  assembly_.state.last_step.mean_spin = reduction.rotation.transpose() * assembly_.state.last_step.mean_spin;
  rate_mid_ = reduction.rotation.transpose() * rate_mid_ * reduction.rotation;
  if (at_rate_ && path_.steps > 0) {
    const Vector3 faster = rotation_vector(more) / (step_ * double(path_.steps));
    omega_ += faster;
    rate_mid_ -= cross_matrix(faster);  // their sum is the velocity gradient of the step just made
  }
  c_.lattice = upper_triangle(assembly_.cell.lattice);
  set_rate(assembly_.state.last_step.rate, c_);
  moment_before_ = reduction.rotation.transpose() * moment_before_ * reduction.rotation;
}

void SubSteps::update_pairs() {
  Dissipation lost;
  clock_.begin_pairs();
  if (model_.options.energy_balance)
    kernels_.pairs_with_losses(c_, pairs_, assembly_.rows.data(), 0, long(assembly_.pairs.padded()), &lost);
  else
    sweep_pairs(kernels_.pairs, c_, pairs_, assembly_.rows.data(), long(assembly_.pairs.padded()), team_);
  gather_pairs_that_touch(assembly_.pairs);
  if (has_interactions(assembly_)) {
    if (model_.options.energy_balance) released_.keep(assembly_);
    update_interactions(model_, kernels_, c_, assembly_);
    if (model_.options.energy_balance) released_.book(model_, assembly_);
  }
  clock_.end_pairs();
  if (model_.options.energy_balance)
    book_step(model_, assembly_, lost, sums_, step_, at_rate_, rate_mid_ + cross_matrix(omega_), moment_before_);
}

bool SubSteps::can_wait(bool forces_asked, long made) const {
  return in_one_sweep_ && !forces_asked && path_.done < path_.steps && !clock_.samples(made) &&
         !clock_.samples(made + 1);
}

void SubSteps::look_ahead() {
  const double rest = step_ * double(path_.steps - path_.done);
  const Collisions ahead =
      collisions_ahead(model_, assembly_, nullptr, what_.follow_collisions,
                       {assembly_.state.last_step.rate, rest, std::numeric_limits<double>::infinity(), step_});
  if (what_.follow_collisions) divide_rest(model_, ahead, assembly_, path_, step_);
  if (ahead.deep) check_every_ = deep_check;
}

/// |B| of x <- A x + dt B v' (kernels/integrate.hpp) at most: B is the stretch of half a sub-step, below a hundredth.
constexpr double largest_stretch = 1.01;

Advanced SubSteps::make() {
  long made = 0, since_check = 0;
  for (; path_.done < path_.steps; ++made) {
    clock_.begin_step(made);
    if (model_.stop != nullptr && model_.stop->load(std::memory_order_relaxed)) throw Interrupted();
    move_cell();
    move_grains();
    const double travel = largest_stretch * step_ * std::sqrt(sums_.largest_speed_squared);
    assembly_.state.list.travel += travel;
    const bool stale = list_is_stale(model_, assembly_, what_.follow_collisions ? 2 * travel : 0.0);
    if (stale) list_pairs_anew();
    const bool looks = stale && at_rate_;
    if (can_wait(looks || (check_every_ > 0 && since_check + 1 >= check_every_), made))
      waiting_.wait(c_);
    else
      update_pairs();
    if (looks) look_ahead();
    if (check_every_ > 0 && ++since_check >= check_every_) {
      since_check = 0;
      check_overlaps(model_, balance_of(model_, assembly_));
    }
  }
  assembly_.state.grain_steps += std::uint64_t(made) * model_.size();
  if (!at_rate_) {
    assembly_.state.masses.steps += made;
    assembly_.state.control.lag.steps += made;
    assembly_.state.control.steps_at_fixed_shape =
        what_.increment.rigid ? assembly_.state.control.steps_at_fixed_shape + made : 0;
  }
  turn_frame(assembly_.cell, path_.end_rotation);
  return {made, step_};
}

}  // namespace

Advanced make_substeps(const Model& model, Assembly& assembly, const Advance& what) {
  return SubSteps(model, assembly, what).make();
}

}  // namespace rvelab
