// The sub-step at a rate. Declared in at_rate.hpp.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "rvelab/error.hpp"
#include "rvelab/solver/assembly/contact_stiffness.hpp"
#include "rvelab/solver/assembly/pair_geometry.hpp"
#include "rvelab/solver/at_rate/at_rate.hpp"
#include "rvelab/solver/loading/collisions.hpp"

namespace rvelab {

namespace {

struct Spring {
  std::size_t i, j;
  Vector3 normal;
  double normal_stiffness, tangential_stiffness, rolling_stiffness;  ///< N/m, N/m, N m
  double arm_i, arm_j;                                               ///< m
};

template <Shape shape, class Force>
std::vector<Spring> springs_of(const Model& model, const Assembly& assembly) {
  std::vector<Spring> springs;
  each_touching<shape>(model, assembly, [&](std::size_t p, const auto& at) {
    const auto i = std::size_t(assembly.pairs.i[p]), j = std::size_t(assembly.pairs.j[p]);
    const ContactStiffness k = stiffness_of<Force>(model, parameters_of(model, assembly.pairs, p), at.overlap,
                                                   hertz_radius_ratio(model, assembly.pairs, p, at));
    const Branch& along = at.along();
    springs.push_back({i, j, Vector3(along.x, along.y, along.z) / at.along_length(), k.normal, k.tangential, k.rolling,
                       model.radius[i] - at.overlap / 2, model.radius[j] - at.overlap / 2});
  });
  return springs;
}

/// Displacements and rotations of all grains.
struct Displacements {
  std::vector<Vector3> shift, turn;
};

/// forces = K motion; twice the energy of the motion.
double stiffness_times(const std::vector<Spring>& springs, const Displacements& motion, Displacements& forces) {
  for (std::size_t g = 0; g < motion.shift.size(); ++g) forces.shift[g] = forces.turn[g] = Vector3::Zero();
  double energy = 0;
  for (const Spring& s : springs) {
    const Vector3& n = s.normal;
    const Vector3 apart = motion.shift[s.j] - motion.shift[s.i];
    const double opening = n.dot(apart);
    const Vector3 slip = apart - opening * n - (s.arm_i * motion.turn[s.i] + s.arm_j * motion.turn[s.j]).cross(n);
    const Vector3 twist = motion.turn[s.j] - motion.turn[s.i], roll = twist - n.dot(twist) * n;
    const Vector3 force = s.normal_stiffness * opening * n + s.tangential_stiffness * slip;
    const Vector3 torque = s.tangential_stiffness * n.cross(slip), moment = s.rolling_stiffness * roll;
    forces.shift[s.j] += force;
    forces.shift[s.i] -= force;
    forces.turn[s.j] += moment - s.arm_j * torque;
    forces.turn[s.i] -= moment + s.arm_i * torque;
    energy += s.normal_stiffness * opening * opening + s.tangential_stiffness * slip.squaredNorm() +
              s.rolling_stiffness * roll.squaredNorm();
  }
  return energy;
}

double largest_quotient(const Model& model, const std::vector<Spring>& springs) {
  constexpr int iterations = 60;
  const std::size_t n = model.size();
  const int d = model.dimension();
  const bool turns = model.round();
  Displacements motion{std::vector<Vector3>(n, Vector3::Zero()), std::vector<Vector3>(n, Vector3::Zero())},
      forces = motion;
  std::uint64_t number = 1;
  const auto drawn = [&number] {  // of a linear congruential generator (Knuth, MMIX), -1/2 to 1/2
    number = number * 6364136223846793005u + 1442695040888963407u;
    return double(number >> 11) / 9007199254740992.0 - 0.5;
  };
  for (std::size_t g = 0; g < n; ++g) {
    for (int k = 0; k < d; ++k) motion.shift[g][k] = drawn();
    if (turns)
      for (int k = d == 2 ? 2 : 0; k < 3; ++k) motion.turn[g][k] = drawn() / model.radius[g];
  }
  double largest = 0;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    double inertia = 0;
    for (std::size_t g = 0; g < n; ++g)
      inertia += model.mass[g] * motion.shift[g].squaredNorm() + model.inertia[g] * motion.turn[g].squaredNorm();
    if (!(inertia > 0)) break;
    largest = std::max(largest, stiffness_times(springs, motion, forces) / inertia);
    const double scale = 1 / std::sqrt(inertia);
    for (std::size_t g = 0; g < n; ++g) {
      motion.shift[g] = forces.shift[g] * (scale / model.mass[g]);
      motion.turn[g] = turns ? Vector3(forces.turn[g] * (scale / model.inertia[g])) : Vector3(Vector3::Zero());
    }
  }
  return std::sqrt(largest);
}

/// A frequency (rad/s) that some motion of the grains has, by the power method on M^-1 K: at most the largest one, and
/// of small networks within 2 % of it. K holds the springs of the contacts as they are (loading/inertia.hpp), not the
/// dashpots; of grains that are not round the translations only. A time step beyond 2 over it is unstable for certain,
/// one beyond that of the row sums need not be. 0 without contacts. It takes as long as some hundred sub-steps.
double frequency_reached(const Model& model, const Assembly& assembly) {
  return with_force(model, [&](auto force) {
    using Force = decltype(force);
    return with_shape(model.shape, [&](auto shape) {
      return largest_quotient(model, springs_of<shape.value, Force>(model, assembly));
    });
  });
}

void expect_stable(State& state, double step) {
  // Of the springs: the bound with dashpots is several times below where restitution 0.1 errs. The row sums are a bound
  // from one side: YADE's step of its dense packing is 1.26 times theirs and stable.
  RowSums springs = state.row_sums();
  springs.dashpot.clear();
  if (step <= critical_step(state.model(), springs)) return;
  // Of bodies the bound alone.
  const double limit = state.model().bodies ? critical_step(state.model(), springs)
                                            : 2 / frequency_reached(state.model(), state.assembly());
  if (step <= limit) return;
  throw IncrementFailed("solver.fixed_time_step_s = " + in_words(state.model().options.fixed_time_step) +
                        " s is above the critical step, " + in_words(limit) +
                        " s, of the contacts as they are: energy would come from nowhere; give at most 0.7 of it, or "
                        "0 for steps that follow the contacts");
}

}  // namespace

TimeStep time_step(State& state, const Matrix3& rate, long interval, double dt) {
  const Model& model = state.model();
  check_height(model, state.cell());  // lists do it too, but may live long
  const double fixed = model.options.fixed_time_step;
  if (fixed > 0) {
    const Collisions ahead =
        collisions_ahead(model, state.assembly(), nullptr, false, {rate, double(interval) * fixed, dt});
    if (ahead.beyond) state.checked_balance();
    expect_stable(state, std::min(fixed, dt));
    return {fixed, interval, ahead.deep};
  }
  double stable = model.options.time_step_factor * critical_step(model, with_floor(state.row_sums(), model));
  // Strong local damping takes (1 - alpha) to (1 + alpha) of the force as the motion turns: at 0.99 an eighth of the
  // energy came from nowhere at the critical step. (2 (1 - alpha))^(3/4): with the root the energy balance is open by
  // 1.7 %.
  const double damping = 2 * (1 - model.damping.local);
  if (damping < 1) stable *= std::sqrt(damping * std::sqrt(damping));
  const double horizon = std::min(double(interval) * stable, dt);
  const Collisions ahead = collisions_ahead(model, state.assembly(), &state.row_sums(), true, {rate, horizon, dt});
  if (ahead.beyond) state.checked_balance();
  const double longest = std::min(stable, ahead.step);
  const double steps = std::clamp(std::ceil(ahead.look / longest), 10.0, double(interval));
  return {longest, long(steps), ahead.deep};
}

}  // namespace rvelab
