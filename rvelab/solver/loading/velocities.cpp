#include "rvelab/solver/loading/velocities.hpp"

#include "rvelab/solver/loading/body_motion.hpp"
#include "rvelab/solver/loading/inertia.hpp"

namespace rvelab {

Matrix3 reynolds_stress_times_volume(const Model& model, const Assembly& assembly) {
  if (model.bodies) return reynolds_of_bodies(model, assembly);
  // Called every few sub-steps under stress control.
  const Vector3 mean = assembly.state.last_step.mean_velocity;
  std::vector<Matrix3> of_piece(pieces_in(model.size()));
  in_pieces(model.size(), model.sharing(), [&](std::size_t piece, std::size_t first, std::size_t last) {
    double xx = 0, yy = 0, zz = 0, yz = 0, xz = 0, xy = 0;
    const double* v = assembly.rows.data() + first * model.row_length() + model.velocity_offset();
    for (std::size_t g = first; g < last; ++g, v += model.row_length()) {
      const double mass = assembly.mass[g], x = v[0] - mean[0], y = v[1] - mean[1];
      xx -= mass * (x * x);
      yy -= mass * (y * y);
      xy -= mass * (x * y);
      if (model.dimension() == 2) continue;
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

double kinetic_energy(const Model& model, const Assembly& assembly) {
  if (model.bodies) return kinetic_energy_of_bodies(model, assembly);
  double sum = 0;
  for (std::size_t g = 0; g < model.size(); ++g) {
    sum += 0.5 * assembly.velocity(model, g).squaredNorm() * assembly.mass[g];
    if (assembly.inverse_inertia[g] > 0)
      sum += 0.5 * assembly.spin(model, g).squaredNorm() / assembly.inverse_inertia[g];
  }
  return sum;
}

namespace {

void zero_velocities(const Model& model, Assembly& assembly) {
  for (std::size_t g = 0; g < model.size(); ++g) assembly.set_velocity(model, g, Vector3::Zero(), Vector3::Zero());
  stop_bodies(assembly);
  assembly.state.last_step.mean_velocity.setZero();
}

}  // namespace

void stop_grains(const Model& model, Assembly& assembly) {
  if (model.options.energy_balance) assembly.state.energy_balance.removed_kinetic += kinetic_energy(model, assembly);
  zero_velocities(model, assembly);
}

void rescale_inertia(const Model& model, const RowSums& sums, Assembly& assembly) {
  const double before = model.options.energy_balance ? kinetic_energy(model, assembly) : 0;
  scale_inertia(model, sums, assembly);
  if (model.options.energy_balance)
    assembly.state.energy_balance.removed_kinetic += before - kinetic_energy(model, assembly);
}

void set_loading(const Model& model, Assembly& assembly, Loading loading) {
  LastStep& last = assembly.state.last_step;
  if (loading != last.loading) {
    // Physical velocities mean nothing to scaled masses, nor the reverse: carried over they would be an impact. Their
    // energy is booked.
    if (model.options.energy_balance && last.loading == Loading::at_rate)
      assembly.state.energy_balance.removed_kinetic += kinetic_energy(model, assembly);
    zero_velocities(model, assembly);
    last = {loading, Matrix3::Zero(), loading == Loading::quasi_static ? 1.0 : 0.0, Vector3::Zero(), Vector3::Zero()};
    assembly.state.servo.rate.setZero();
    if (model.damping.dashpot != Dashpot::none) evaluate_forces(model, assembly);  // no velocity, no dashpot force
  }
  if (loading == Loading::quasi_static) return;
  use_physical_inertia(model, assembly);
  assembly.state.masses = {};
}

}  // namespace rvelab
