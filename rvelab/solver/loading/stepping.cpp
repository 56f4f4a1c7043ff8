#include "rvelab/solver/loading/stepping.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "rvelab/error.hpp"
#include "rvelab/solver/loading/collisions.hpp"
#include "rvelab/solver/loading/inertia.hpp"
#include "rvelab/solver/loading/step_times.hpp"
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

/// Maps of velocity and spin at dt > 0 (solver/README.md, equations of motion): dv'/dt = f/m - (D + 2 Omega) v', dw/dt
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
  const double alpha = loading == Loading::physical ? d.local : d.local_quasi_static;
  if (alpha == 0) return KernelDamping::none;
  return d.local_form == LocalDampingForm::vector ? KernelDamping::vector : KernelDamping::component;
}

}  // namespace

Vector3 rotation_vector(const Matrix3& rotation) {
  // Quaternion, halved until the angle is small enough for the series of asin.
  Matrix3 r = rotation;
  const double trace = r.trace();
  double w, x, y, z;
  if (trace > 0) {
    const double s = std::sqrt(trace + 1) * 2;
    w = 0.25 * s;
    x = (r(2, 1) - r(1, 2)) / s;
    y = (r(0, 2) - r(2, 0)) / s;
    z = (r(1, 0) - r(0, 1)) / s;
  } else {
    int i = 0;
    if (r(1, 1) > r(0, 0)) i = 1;
    if (r(2, 2) > r(i, i)) i = 2;
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double s = std::sqrt(r(i, i) - r(j, j) - r(k, k) + 1) * 2;
    double q[3];
    q[i] = 0.25 * s;
    q[j] = (r(j, i) + r(i, j)) / s;
    q[k] = (r(k, i) + r(i, k)) / s;
    w = (r(k, j) - r(j, k)) / s;
    x = q[0];
    y = q[1];
    z = q[2];
    if (w < 0) {
      w = -w;
      x = -x;
      y = -y;
      z = -z;
    }
  }
  double factor = 2;
  for (int halving = 0; halving < 6; ++halving) {
    const double half = std::sqrt(0.5 * (1 + w));
    x /= 2 * half;
    y /= 2 * half;
    z /= 2 * half;
    w = half;
    factor *= 2;
  }
  const double s2 = x * x + y * y + z * z;
  const double series = 1 + s2 * (1.0 / 6 + s2 * (3.0 / 40 + s2 * (15.0 / 336)));
  return factor * series * Vector3(x, y, z);
}

Matrix3 kinetic_moment(const Fixture& f, const Assembly& a) {
  // Called every few sub-steps under stress control.
  const Vector3 mean = a.state.mean_velocity;
  std::vector<Matrix3> of_piece(pieces_in(f.size()));
  in_pieces(f.size(), f.sharing(), [&](std::size_t piece, std::size_t first, std::size_t last) {
    double xx = 0, yy = 0, zz = 0, yz = 0, xz = 0, xy = 0;
    const double* v = a.rows.data() + first * f.row_length() + f.velocity_offset();
    for (std::size_t g = first; g < last; ++g, v += f.row_length()) {
      const double mass = a.mass[g], x = v[0] - mean[0], y = v[1] - mean[1];
      xx -= mass * (x * x);
      yy -= mass * (y * y);
      xy -= mass * (x * y);
      if (f.dimension() == 2) continue;
      const double z = v[2] - mean[2];
      zz -= mass * (z * z);
      yz -= mass * (y * z);
      xz -= mass * (x * z);
    }
    of_piece[piece] << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  });
  Matrix3 sum = Matrix3::Zero();
  for (const Matrix3& piece : of_piece) sum += piece;
  return sum;
}

double kinetic_energy(const Fixture& f, const Assembly& a) {
  double sum = 0;
  for (std::size_t g = 0; g < f.size(); ++g) {
    sum += 0.5 * a.velocity(f, g).squaredNorm() * a.mass[g];
    if (a.inverse_inertia[g] > 0) sum += 0.5 * a.spin(f, g).squaredNorm() / a.inverse_inertia[g];
  }
  return sum;
}

namespace {

void zero_velocities(const Fixture& f, Assembly& a) {
  for (std::size_t g = 0; g < f.size(); ++g) a.set_velocity(f, g, Vector3::Zero(), Vector3::Zero());
  a.state.mean_velocity.setZero();
}

}  // namespace

void stop_grains(const Fixture& f, Assembly& a) {
  if (f.options.ledger) a.state.ledger.zeroing += kinetic_energy(f, a);
  zero_velocities(f, a);
}

void rescale_inertia(const Fixture& f, const RowSums& sums, Assembly& a) {
  const double before = f.options.ledger ? kinetic_energy(f, a) : 0;
  scale_inertia(f, sums, a);
  if (f.options.ledger) a.state.ledger.zeroing += before - kinetic_energy(f, a);
}

void begin_loading(const Fixture& f, Assembly& a, Loading loading) {
  const bool quasi_static = loading == Loading::quasi_static;
  if (quasi_static != a.state.quasi_static) {
    // Physical velocities mean nothing to scaled masses, nor the reverse: carried over they would be an impact. Their
    // energy is booked.
    if (f.options.ledger && !a.state.quasi_static) a.state.ledger.zeroing += kinetic_energy(f, a);
    zero_velocities(f, a);
    a.state.last_rate.setZero();
    a.state.mean_spin.setZero();
    a.state.servo_rate.setZero();
    a.state.last_step = quasi_static ? 1 : 0;
    a.state.quasi_static = quasi_static;
    if (f.damping.dashpot != Dashpot::none) evaluate_forces(f, a);  // no velocity, no dashpot force
  }
  if (quasi_static) return;
  use_physical_inertia(f, a);
  a.state.look_steps = -1;
}

namespace {

/// Books one sub-step; `moment_before` is the contacts' moment at its start, and becomes that at its end.
void book_step(const Fixture& f, Assembly& a, const Dissipation& lost, const StepSums& sums, double step, bool physical,
               const Matrix3& gradient, Matrix3& moment_before) {
  EnergyLedger& ledger = a.state.ledger;
  const Matrix3 moment = contact_moment(f, a);
  // V sigma = -sum F (x) b - sum m v' v'; the contact part by the trapezium, the kinetic one at the half step.
  Matrix3 work = -0.5 * (moment_before + moment);
  if (physical) work += kinetic_moment(f, a);
  ledger.boundary_work += step * work.cwiseProduct(gradient).sum();
  ledger.friction += lost.friction;
  ledger.rolling += lost.rolling;
  ledger.dashpot += lost.dashpot;
  ledger.law_loss += lost.law_loss;
  ledger.local_damping += sums.local_damping;
  ledger.global_damping += sums.global_damping;
  moment_before = moment;
}

/// Velocities are those of the half step behind. Where the step changes that half step does too: v' <- v' + (dt_old -
/// dt_new)/2 f/m (and w'), without which a Hertz impact gains 2 % of its energy from the steps that it asks for.
/// Changes of less than a hundredth are let be.
void shift_half_step(const Fixture& f, Assembly& a, double step) {
  const double shift = 0.5 * (a.state.last_step - step);
  if (f.options.fixed_time_step > 0 || !(a.state.last_step > 0) || std::abs(shift) < 0.005 * a.state.last_step) return;
  const std::vector<Resultant> resultants = resultants_of(f, a);
  for (std::size_t g = 0; g < f.size(); ++g)
    a.set_velocity(f, g, a.velocity(f, g) + shift * a.inverse_mass[g] * resultants[g].force,
                   a.spin(f, g) + shift * a.inverse_inertia[g] * resultants[g].torque);
  a.state.last_step = step;
}

/// Divides the sub-steps that are left, so that the collisions that a new list shows are followed.
void divide_rest(const Fixture& f, const Collisions& ahead, Assembly& a, LatticePath& path, double& step) {
  if (!(ahead.step < step)) return;
  const double parts = std::ceil(step / ahead.step), left = double(path.steps - path.done) * parts;
  if (left > double(f.options.max_substeps))
    throw IncrementFailed("collisions in the increment need sub-steps of " + in_words(step / parts) +
                          " s; solver.max_substeps = " + std::to_string(f.options.max_substeps) +
                          " allows none so short; apply it in smaller parts or lower solver.collision_steps");
  path.start = a.cell.lattice;
  path.steps = long(left);
  path.done = 0;
  step /= parts;
  shift_half_step(f, a, step);
}

}  // namespace

Advanced advance(const Fixture& f, Assembly& a, const Advance& what) {
  const bool physical = what.loading == Loading::physical;
  StepConstants c = base_constants(f, a);
  c.losses = f.options.ledger;
  c.local_damping = physical ? f.damping.local : f.damping.local_quasi_static;
  const auto kind = std::size_t(damping_kind(f.damping, what.loading));
  const Kernels& kernels = f.kernels_at(a.state.quasi_static);
  const GrainKernel move = physical ? kernels.dynamic[kind] : kernels.quasi_static[kind];

  LatticePath path{a.cell.lattice, what.increment.stretch * a.cell.lattice, what.increment.rotation, 0, what.steps};
  Vector3 omega = Vector3::Zero();
  double step = what.step;
  if (physical) shift_half_step(f, a, step);
  long made = 0, look_every = what.look_every, since_look = 0;
  if (physical) omega = rotation_vector(what.increment.rotation) / (step * double(what.steps));
  double total_mass = 0;
  for (std::size_t g = 0; g < f.size(); ++g) total_mass += a.mass[g];
  PairArrays pairs = arrays_of(a.pairs);
  GrainArrays grains = arrays_of(f, a);
  const long padded_grains = long(a.mass.size());
  Workers* team = f.sharing();
  StepSums sums;
  Matrix3 rate_end, rate_mid, moment_before = Matrix3::Zero();
  if (f.options.ledger) moment_before = contact_moment(f, a);

  StepClock clock(f.times);
  for (; path.done < path.steps; ++made) {
    clock.begin_step(made);
    if (f.stop != nullptr && f.stop->load(std::memory_order_relaxed)) throw Interrupted();
    const Matrix3 before = a.cell.lattice;
    a.cell.lattice = path.lattice_after(++path.done);
    set_step(before, a.cell.lattice, step, c, rate_end, rate_mid);
    for (int k = 0; k < 3; ++k) c.mean_velocity[k] = a.state.mean_velocity[k];
    if (physical) {
      const Vector3 mean_spin = axial(rate_mid) + omega;
      set_frame_terms(rate_mid, omega, mean_spin - a.state.mean_spin, c);
      a.state.mean_spin = mean_spin;
    }
    clock.begin_grains();
    sweep_grains(move, c, grains, pairs, padded_grains, team, sums);
    clock.end_grains();
    // The rows that pad the lanes lose the mean velocity too, step after step; their speed must never count.
    std::fill(a.rows.begin() + std::ptrdiff_t(f.size()) * f.row_length(), a.rows.end(), 0.0);
    for (int k = 0; k < 3; ++k) a.state.mean_velocity[k] = sums.momentum[k] / total_mass;
    const double travel = 1.01 * step * std::sqrt(sums.largest_speed_squared);
    a.state.list_travel += travel;
    ++a.state.list_steps;
    a.state.last_rate = rate_end;
    a.state.last_step = step;
    const bool listed_anew = list_is_stale(f, a, what.follow_collisions ? 2 * travel : 0.0);
    if (listed_anew) {
      clock.begin_list();
      const Matrix3 lattice_before = a.cell.lattice;
      const Reduction reduction = rebuild(f, a);
      if (reduction.changed) {
        const Matrix3 more = turn_path(path, lattice_before, reduction, a.cell);
        omega = reduction.rotation.transpose() * omega;
        a.state.mean_spin = reduction.rotation.transpose() * a.state.mean_spin;
        rate_mid = reduction.rotation.transpose() * rate_mid * reduction.rotation;
        if (physical && path.steps > 0) {
          const Vector3 faster = rotation_vector(more) / (step * double(path.steps));
          omega += faster;
          rate_mid -= cross_matrix(faster);  // their sum is the velocity gradient of the step just made
        }
        c.lattice = upper_triangle(a.cell.lattice);
        set_rate(a.state.last_rate, c);
        moment_before = reduction.rotation.transpose() * moment_before * reduction.rotation;
      }
      pairs = arrays_of(a.pairs);
      grains = arrays_of(f, a);
      clock.end_list();
    }
    Dissipation lost;
    clock.begin_pairs();
    if (f.options.ledger)
      kernels.pairs_ledger(c, pairs, a.rows.data(), 0, long(a.pairs.padded()), &lost);
    else
      sweep_pairs(kernels.pairs, c, pairs, a.rows.data(), long(a.pairs.padded()), team);
    clock.end_pairs();
    if (f.options.ledger) book_step(f, a, lost, sums, step, physical, rate_mid + cross_matrix(omega), moment_before);
    if (listed_anew && physical) {
      const double rest = step * double(path.steps - path.done);
      const Collisions ahead = collisions_ahead(f, a, nullptr, what.follow_collisions,
                                                {a.state.last_rate, rest, std::numeric_limits<double>::infinity()});
      if (what.follow_collisions) divide_rest(f, ahead, a, path, step);
      if (ahead.deep) look_every = deep_look;
    }
    if (look_every > 0 && ++since_look >= look_every) {
      since_look = 0;
      check_overlaps(f, balance_of(f, a));
    }
  }
  a.state.grain_steps += std::uint64_t(made) * f.size();
  if (!physical) {
    a.state.look_steps += made;
    a.state.lag_steps += made;
    a.state.rest_steps = what.increment.rigid ? a.state.rest_steps + made : 0;
  }
  turn_frame(a.cell, path.end_rotation);
  return {made, step};
}

}  // namespace rvelab
