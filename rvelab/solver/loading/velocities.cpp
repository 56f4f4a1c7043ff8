#include "rvelab/solver/loading/velocities.hpp"

#include "rvelab/solver/loading/inertia.hpp"

namespace rvelab {

Matrix3 kinetic_moment(const Model& f, const Assembly& a) {
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

double kinetic_energy(const Model& f, const Assembly& a) {
  double sum = 0;
  for (std::size_t g = 0; g < f.size(); ++g) {
    sum += 0.5 * a.velocity(f, g).squaredNorm() * a.mass[g];
    if (a.inverse_inertia[g] > 0) sum += 0.5 * a.spin(f, g).squaredNorm() / a.inverse_inertia[g];
  }
  return sum;
}

namespace {

void zero_velocities(const Model& f, Assembly& a) {
  for (std::size_t g = 0; g < f.size(); ++g) a.set_velocity(f, g, Vector3::Zero(), Vector3::Zero());
  a.state.mean_velocity.setZero();
}

}  // namespace

void stop_grains(const Model& f, Assembly& a) {
  if (f.options.energy_balance) a.state.energy_balance.removed_kinetic += kinetic_energy(f, a);
  zero_velocities(f, a);
}

void rescale_inertia(const Model& f, const RowSums& sums, Assembly& a) {
  const double before = f.options.energy_balance ? kinetic_energy(f, a) : 0;
  scale_inertia(f, sums, a);
  if (f.options.energy_balance) a.state.energy_balance.removed_kinetic += before - kinetic_energy(f, a);
}

void begin_loading(const Model& f, Assembly& a, Loading loading) {
  const bool quasi_static = loading == Loading::quasi_static;
  if (quasi_static != a.state.quasi_static) {
    // Physical velocities mean nothing to scaled masses, nor the reverse: carried over they would be an impact. Their
    // energy is booked.
    if (f.options.energy_balance && !a.state.quasi_static)
      a.state.energy_balance.removed_kinetic += kinetic_energy(f, a);
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
  a.state.steps_since_scaling = -1;
}

}  // namespace rvelab
