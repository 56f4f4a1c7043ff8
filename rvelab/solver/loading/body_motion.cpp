#include "rvelab/solver/loading/body_motion.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "rvelab/contact/damping.hpp"
#include "rvelab/solver/assembly/superellipsoid_rows.hpp"

namespace rvelab {

namespace {

Matrix3 of_rows(const double* m) {
  Matrix3 matrix;
  matrix << m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8];
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

template <class Vector>
inline __attribute__((always_inline)) void damp(double alpha, KernelDamping kind, const Vector& ahead, Vector& force) {
  if (kind == KernelDamping::vector)
    force -= local_damping_factor(alpha, force.squaredNorm(), ahead.squaredNorm()) * ahead;
  else
    for (Eigen::Index k = 0; k < force.size(); ++k) force[k] = damped_component(alpha, force[k], ahead[k]);
}

/// An upper triangular matrix times a vector, in the plane or in space.
template <int D>
inline __attribute__((always_inline)) Eigen::Matrix<double, D, 1> times(const UpperTriangle& m,
                                                                        const Eigen::Matrix<double, D, 1>& v) {
  if constexpr (D == 2)
    return {m.xx * v[0] + m.xy * v[1], m.yy * v[1]};
  else
    return {m.xx * v[0] + (m.xy * v[1] + m.xz * v[2]), m.yy * v[1] + m.yz * v[2], m.zz * v[2]};
}

/// Of a body with its members; `Solid`: one grain with a shape of its own. Where the plane needs less than space it is
/// written apart: a sub-step of clumps of discs took 1.9 times as long with quaternions.
template <int D, bool Solid>
class BodyMover {
 public:
  using Vector = Eigen::Matrix<double, D, 1>;

  BodyMover(const Model& model, const BodyStep& step, Assembly& assembly)
      : model_(model),
        bodies_(*model.bodies),
        step_(step),
        c_(step.constants),
        assembly_(assembly),
        inverse_stretch_(upper_triangle(step.inverse_stretch)),
        gradient_(upper_triangle(step.gradient)),
        cell_spin_(c_.spin[0], c_.spin[1], c_.spin[2]),
        mean_(Vector3(c_.mean_velocity[0], c_.mean_velocity[1], c_.mean_velocity[2]).template head<D>()) {
    if (!step.at_rate) return;
    momentum_map_ = of_rows(c_.momentum_map);
    force_map_ = of_rows(c_.force_map);
    if (D == 3) frame_back_ = of_rows(c_.spin_map);
    back_ = turn_of(frame_back_);
  }

  inline __attribute__((always_inline)) void move(std::size_t b, const Resultant& on_body, StepSums& sums) {
    BodyMotion& m = assembly_.bodies.motion[b];
    Vector force = on_body.force.template head<D>();
    Vector3 torque = on_body.torque;
    double mass = 0;
    for (auto g = std::size_t(bodies_.first[b]); g < std::size_t(bodies_.first[b + 1]); ++g) mass += assembly_.mass[g];
    const double inverse_mass = 1 / mass;
    Vector v = m.velocity.template head<D>() - mean_;
    if (step_.at_rate && c_.global_viscous != 0) {
      force -= c_.global_viscous * v;
      if (c_.losses) sums.global_damping += c_.dt * c_.global_viscous * v.squaredNorm();
    }
    if (step_.damping != KernelDamping::none) {
      const Vector ahead = v + (0.5 * c_.dt * inverse_mass) * force, free_force = force;
      damp(c_.local_damping, step_.damping, ahead, force);
      const Vector3 spin_ahead = m.spin + 0.5 * c_.dt * accelerated(b, torque), free_torque = torque;
      if constexpr (D == 2)
        torque[2] = damped_component(c_.local_damping, torque[2], spin_ahead[2]);
      else
        damp(c_.local_damping, step_.damping, spin_ahead, torque);
      if (step_.at_rate && c_.losses)
        sums.local_damping += c_.dt * ((free_force - force).dot(ahead) + (free_torque - torque).dot(spin_ahead));
    }
    const Vector gained = c_.dt * (inverse_mass * force);
    if (step_.at_rate)
      v = momentum_map_.template topLeftCorner<D, D>() * v + force_map_.template topLeftCorner<D, D>() * gained;
    else
      v += gained;
    const Vector3 spin_in_cell = turn(b, torque, m);
    const Vector x = m.position.template head<D>();
    m.position.template head<D>() = times<D>(c_.map, x) + times<D>(c_.velocity_map, v);
    m.velocity.template head<D>() = v;
    for (int k = 0; k < D; ++k) sums.momentum[k] += mass * v[k];
    if constexpr (Solid)
      place_solid(b, m, v, spin_in_cell, sums);
    else
      place_members(b, m, v, spin_in_cell, sums);
  }

 private:
  /// I^-1 T, cell frame.
  inline __attribute__((always_inline)) Vector3 accelerated(std::size_t b, const Vector3& torque) const {
    if (!step_.at_rate) return assembly_.inverse_inertia[std::size_t(bodies_.first[b])] * torque;
    return inverse_inertia_of(bodies_, assembly_, b, true) * torque;
  }

  /// Spin and orientation after the step; returns the spin of its turn in the cell frame, rad/s.
  inline __attribute__((always_inline)) Vector3 turn(std::size_t b, const Vector3& torque, BodyMotion& m) const {
    if constexpr (D == 3)
      if (step_.at_rate) return turn_at_rate(b, torque, m);
    if (step_.at_rate)
      m.spin[2] += (step_.mean_spin_before[2] - step_.mean_spin[2]) +
                   c_.dt * (torque[2] / (bodies_.mass[b] * bodies_.gyration[b][2]));
    else
      m.spin += c_.dt * accelerated(b, torque);
    const Vector3 spin_in_cell = m.spin + cell_spin_;
    if constexpr (D == 2) {
      const double half = 0.5 * c_.dt * spin_in_cell[2], w = m.orientation.w - half * m.orientation.v[2],
                   z = m.orientation.v[2] + half * m.orientation.w, scale = 1 / std::sqrt(w * w + z * z);
      m.orientation.w = scale * w;
      m.orientation.v[2] = scale * z;
    } else {
      m.orientation = normalised(after(Turn{1, 0.5 * c_.dt * spin_in_cell}, m.orientation));
    }
    return spin_in_cell;
  }

  Vector3 turn_at_rate(std::size_t b, const Vector3& torque, BodyMotion& m) const {
    const Turn before = m.orientation;
    const Vector3 moments = bodies_.moments(b);
    const Matrix3 axes = axes_of(before);
    Vector3 momentum = moments.cwiseProduct(axes.transpose() * (m.spin + step_.mean_spin_before)) +
                       c_.dt * (axes.transpose() * torque);
    rotate_freely(c_.dt, moments, momentum, m.orientation);
    if (!frame_back_.isIdentity(0)) m.orientation = normalised(after(back_, m.orientation));
    m.spin = axes_of(m.orientation) * momentum.cwiseQuotient(moments) - step_.mean_spin;
    return cayley_vector(after(m.orientation, inverse(before))) / c_.dt;
  }

  /// Its surface comes nearer by the turn too (assembly/oriented_bounds.hpp).
  inline __attribute__((always_inline)) void place_solid(std::size_t b, const BodyMotion& m, const Vector& v,
                                                         const Vector3& spin_in_cell, StepSums& sums) {
    const Vector3 spin = spin_in_cell - cell_spin_;
    const UpperTriangle& l = c_.lattice;
    const Image& image = assembly_.bodies.image[b];
    const double nx = image[0], ny = image[1], nz = image[2];
    double* row = assembly_.rows.data() + b * std::size_t(SuperellipsoidGrain::row_length);
    row[0] = m.position[0] + (l.xx * nx + (l.xy * ny + l.xz * nz));
    row[1] = m.position[1] + (l.yy * ny + l.yz * nz);
    row[2] = m.position[2] + l.zz * nz;
    for (int k = 0; k < 3; ++k) row[4 + k] = v[k];
    for (int k = 0; k < 3; ++k) row[8 + k] = spin[k];
    put_orientation(m.orientation, row);
    const double fastest = v.norm() + row[23] * spin_in_cell.norm();
    sums.largest_speed_squared = std::max(sums.largest_speed_squared, fastest * fastest);
  }

  inline __attribute__((always_inline)) void place_members(std::size_t b, const BodyMotion& m, const Vector& v,
                                                           const Vector3& spin_in_cell, StepSums& sums) {
    const Matrix3 axes = axes_of(m.orientation);
    const Vector3 spin = spin_in_cell - cell_spin_;
    const UpperTriangle& l = c_.lattice;
    const Vector centre = m.position.template head<D>();
    for (auto g = std::size_t(bodies_.first[b]); g < std::size_t(bodies_.first[b + 1]); ++g) {
      const Vector from = assembly_.bodies.arm[g].template head<D>();
      const Vector arm = axes.template topLeftCorner<D, D>() * bodies_.offset[g].template head<D>();
      assembly_.bodies.arm[g].template head<D>() = arm;
      const Vector middle = 0.5 * (from + arm);
      Vector turning;
      if constexpr (D == 2)
        turning = Vector(-spin_in_cell[2] * middle[1], spin_in_cell[2] * middle[0]);
      else
        turning = spin_in_cell.cross(middle);
      const Vector velocity = v + times<D>(inverse_stretch_, turning) - times<D>(gradient_, from);
      const Image& image = assembly_.bodies.image[g];
      const double nx = image[0], ny = image[1], nz = image[2];
      double* row = assembly_.rows.data() + g * std::size_t(model_.row_length());
      row[0] = centre[0] + arm[0] + (l.xx * nx + (l.xy * ny + l.xz * nz));
      row[1] = centre[1] + arm[1] + (l.yy * ny + l.yz * nz);
      if constexpr (D == 2) {
        row[2] = velocity[0];
        row[3] = velocity[1];
        row[4] = spin[2];
      } else {
        row[2] = centre[2] + arm[2] + l.zz * nz;
        for (int k = 0; k < 3; ++k) row[4 + k] = velocity[k];
        for (int k = 0; k < 3; ++k) row[8 + k] = spin[k];
      }
      sums.largest_speed_squared = std::max(sums.largest_speed_squared, velocity.squaredNorm());
    }
  }

  const Model& model_;
  const BodyModel& bodies_;
  const BodyStep& step_;
  const StepConstants& c_;
  Assembly& assembly_;
  UpperTriangle inverse_stretch_, gradient_;
  Vector3 cell_spin_;
  Vector mean_;
  Matrix3 momentum_map_ = Matrix3::Identity(), force_map_ = Matrix3::Identity(), frame_back_ = Matrix3::Identity();
  Turn back_;
};

template <int D, bool Solid>
void move_all(const Model& model, const BodyStep& step, Assembly& assembly, StepSums& sums) {
  std::vector<Resultant> forces;
  gather_on_bodies(model, assembly, forces);
  StepSums of_bodies;
  BodyMover<D, Solid> mover(model, step, assembly);
  for (std::size_t b = 0; b < model.bodies->size(); ++b) mover.move(b, forces[b], of_bodies);
  sums = of_bodies;
}

}  // namespace

void move_bodies(const Model& model, const BodyStep& step, Assembly& assembly, StepSums& sums) {
  if (model.dimension() == 2)
    move_all<2, false>(model, step, assembly, sums);
  else if (moves_as_body(model.shape))
    move_all<3, true>(model, step, assembly, sums);
  else
    move_all<3, false>(model, step, assembly, sums);
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
