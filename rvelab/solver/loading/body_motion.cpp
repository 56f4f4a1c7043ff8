#include "rvelab/solver/loading/body_motion.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "rvelab/contact/damping.hpp"

namespace rvelab {

namespace {

Matrix3 of_rows(const double* m) {
  Matrix3 matrix;
  matrix << m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8];
  return matrix;
}

Matrix3 matrix_of(const UpperTriangle& u) {
  Matrix3 matrix;
  matrix << u.xx, u.xy, u.xz, 0, u.yy, u.yz, 0, 0, u.zz;
  return matrix;
}

/// Mass in use of a body, the sum of its members' shares, kg.
double mass_of(const BodyModel& bodies, const Assembly& assembly, std::size_t b) {
  double mass = 0;
  for (auto g = std::size_t(bodies.first[b]); g < std::size_t(bodies.first[b + 1]); ++g) mass += assembly.mass[g];
  return mass;
}

/// I^-1 in use, cell frame.
Matrix3 inverse_inertia_of(const BodyModel& bodies, const Assembly& assembly, std::size_t b, bool at_rate) {
  if (!at_rate) return assembly.inverse_inertia[std::size_t(bodies.first[b])] * Matrix3::Identity();
  const Matrix3 axes = axes_of(assembly.bodies.motion[b].orientation);
  return axes * bodies.moments(b).cwiseInverse().asDiagonal() * axes.transpose();
}

bool physical(const Assembly& assembly) { return assembly.state.last_step.loading == Loading::at_rate; }

void damp(double alpha, KernelDamping kind, const Vector3& ahead, Vector3& force) {
  if (kind == KernelDamping::vector)
    force -= local_damping_factor(alpha, force.squaredNorm(), ahead.squaredNorm()) * ahead;
  else
    for (int k = 0; k < 3; ++k) force[k] = damped_component(alpha, force[k], ahead[k]);
}

}  // namespace

void move_bodies(const Model& model, const BodyStep& step, Assembly& assembly, StepSums& sums) {
  const BodyModel& bodies = *model.bodies;
  const StepConstants& c = step.constants;
  const Matrix3 map = matrix_of(c.map), velocity_map = matrix_of(c.velocity_map);
  const Vector3 mean = Vector3(c.mean_velocity[0], c.mean_velocity[1], c.mean_velocity[2]);
  const Vector3 cell_spin(c.spin[0], c.spin[1], c.spin[2]);
  const bool plane = model.dimension() == 2;
  const Matrix3 momentum_map = step.at_rate ? of_rows(c.momentum_map) : Matrix3::Identity();
  const Matrix3 force_map = step.at_rate ? of_rows(c.force_map) : Matrix3::Identity();
  const Matrix3 frame_back = step.at_rate && !plane ? of_rows(c.spin_map) : Matrix3::Identity();
  const Turn back = turn_of(frame_back);
  std::vector<Resultant> forces;
  gather_on_bodies(model, assembly, forces);
  sums = {};
  double fastest = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    BodyMotion& m = assembly.bodies.motion[b];
    Vector3 force = forces[b].force, torque = forces[b].torque;
    const double mass = mass_of(bodies, assembly, b);
    const Matrix3 inverse_inertia = inverse_inertia_of(bodies, assembly, b, step.at_rate);
    Vector3 v = m.velocity - mean, w = m.spin;
    if (step.at_rate && c.global_viscous != 0) {
      force -= c.global_viscous * v;
      if (c.losses) sums.global_damping += c.dt * c.global_viscous * v.squaredNorm();
    }
    if (step.damping != KernelDamping::none) {
      const Vector3 ahead = v + (0.5 * c.dt / mass) * force;
      const Vector3 spin_ahead = w + 0.5 * c.dt * (inverse_inertia * torque);
      const Vector3 free_force = force, free_torque = torque;
      damp(c.local_damping, step.damping, ahead, force);
      damp(c.local_damping, plane ? KernelDamping::component : step.damping, spin_ahead, torque);
      if (step.at_rate && c.losses)
        sums.local_damping += c.dt * ((free_force - force).dot(ahead) + (free_torque - torque).dot(spin_ahead));
    }
    const Vector3 gained = c.dt * ((1 / mass) * force);
    v = step.at_rate ? Vector3(momentum_map * v + force_map * gained) : Vector3(v + gained);

    const Turn before = m.orientation;
    Vector3 spin_in_cell;  // of the turn of this step
    if (step.at_rate) {
      const Vector3 moments = bodies.moments(b);
      const Matrix3 axes = axes_of(before);
      Vector3 momentum =
          moments.cwiseProduct(axes.transpose() * (w + step.mean_spin_before)) + c.dt * (axes.transpose() * torque);
      rotate_freely(c.dt, moments, momentum, m.orientation);
      if (!frame_back.isIdentity(0)) m.orientation = normalised(after(back, m.orientation));
      spin_in_cell = cayley_vector(after(m.orientation, inverse(before))) / c.dt;
      w = axes_of(m.orientation) * momentum.cwiseQuotient(moments) - step.mean_spin;
      // In the plane the frame turns about z alone.
      if (plane) {
        spin_in_cell = Vector3(0, 0, w[2] + cell_spin[2]);
        m.orientation = normalised(after(cayley_turn(c.dt * spin_in_cell), before));
        w[0] = w[1] = 0;
      }
    } else {
      w += c.dt * (inverse_inertia * torque);
      spin_in_cell = w + cell_spin;
      m.orientation = normalised(after(cayley_turn(c.dt * spin_in_cell), before));
    }
    m.velocity = v;
    m.spin = w;
    m.position = map * m.position + velocity_map * v;
    if (plane) m.position[2] = 0;
    for (int k = 0; k < 3; ++k) sums.momentum[k] += mass * v[k];

    const Matrix3 axes = axes_of(m.orientation);
    const Vector3 member_spin = spin_in_cell - cell_spin;
    for (auto g = std::size_t(bodies.first[b]); g < std::size_t(bodies.first[b + 1]); ++g) {
      const Vector3 from = assembly.bodies.arm[g], arm = axes * bodies.offset[g];
      assembly.bodies.arm[g] = arm;
      const Vector3 velocity = v + step.inverse_stretch * spin_in_cell.cross(0.5 * (from + arm)) - step.gradient * from;
      const Image& n = assembly.bodies.image[g];
      const UpperTriangle& l = c.lattice;
      const double nx = n[0], ny = n[1], nz = n[2];
      double* row = assembly.rows.data() + g * std::size_t(model.row_length());
      row[0] = m.position[0] + arm[0] + (l.xx * nx + (l.xy * ny + l.xz * nz));
      row[1] = m.position[1] + arm[1] + (l.yy * ny + l.yz * nz);
      if (!plane) row[2] = m.position[2] + arm[2] + l.zz * nz;
      assembly.set_velocity(model, g, velocity, member_spin);
      fastest = std::max(fastest, velocity.squaredNorm());
    }
  }
  sums.largest_speed_squared = fastest;
}

void set_member_velocities(const Model& model, Assembly& assembly) {
  const Matrix3 rate = assembly.state.last_step.rate;
  const Vector3 cell_spin = 0.5 * Vector3(-rate(1, 2), rate(0, 2), -rate(0, 1));
  for (std::size_t g = 0; g < model.size(); ++g) {
    const BodyMotion& m = assembly.bodies.motion[std::size_t(model.bodies->owner[g])];
    const Vector3& arm = assembly.bodies.arm[g];
    assembly.set_velocity(model, g, m.velocity + (m.spin + cell_spin).cross(arm) - rate * arm, m.spin);
  }
}

void shift_bodies(const Model& model, double shift, Assembly& assembly) {
  std::vector<Resultant> forces;
  gather_on_bodies(model, assembly, forces);
  for (std::size_t b = 0; b < forces.size(); ++b) {
    BodyMotion& m = assembly.bodies.motion[b];
    m.velocity += shift / mass_of(*model.bodies, assembly, b) * forces[b].force;
    m.spin += shift * (inverse_inertia_of(*model.bodies, assembly, b, physical(assembly)) * forces[b].torque);
  }
  set_member_velocities(model, assembly);
}

void stop_bodies(Assembly& assembly) {
  for (BodyMotion& m : assembly.bodies.motion) m.velocity = m.spin = Vector3::Zero();
}

double kinetic_energy_of_bodies(const Model& model, const Assembly& assembly) {
  double sum = 0;
  for (std::size_t b = 0; b < model.bodies->size(); ++b) {
    const BodyMotion& m = assembly.bodies.motion[b];
    sum += 0.5 * mass_of(*model.bodies, assembly, b) * m.velocity.squaredNorm();
    if (physical(assembly)) {
      const Vector3 w = axes_of(m.orientation).transpose() * m.spin;
      sum += 0.5 * w.dot(model.bodies->moments(b).cwiseProduct(w));
    } else if (const double inverse = assembly.inverse_inertia[std::size_t(model.bodies->first[b])]; inverse > 0) {
      sum += 0.5 * m.spin.squaredNorm() / inverse;
    }
  }
  return sum;
}

Matrix3 reynolds_of_bodies(const Model& model, const Assembly& assembly) {
  Matrix3 sum = Matrix3::Zero();
  for (std::size_t b = 0; b < model.bodies->size(); ++b) {
    const Vector3 v = assembly.bodies.motion[b].velocity - assembly.state.last_step.mean_velocity;
    sum -= mass_of(*model.bodies, assembly, b) * v * v.transpose();
  }
  if (model.dimension() == 2) sum.row(2).setZero(), sum.col(2).setZero();
  return sum;
}

}  // namespace rvelab
