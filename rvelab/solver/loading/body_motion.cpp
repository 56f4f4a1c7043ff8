#include "rvelab/solver/loading/body_motion.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "rvelab/solver/loading/sweep.hpp"

namespace rvelab {

namespace {

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

BodyArrays arrays_of_bodies(const BodyModel& bodies, Assembly& assembly) {
  BodyArrays a;
  a.motion = assembly.bodies.motion.data()->position.data();
  a.turning = assembly.bodies.turning.data();
  a.first = bodies.first.data();
  for (int k = 0; k < 3; ++k) {
    a.moments[k] = bodies.moments_about[k].data();
    a.inverse_moments[k] = bodies.inverse_moments_about[k].data();
    a.offset[k] = bodies.offset_along[k].data();
    a.arm[k] = assembly.bodies.arms[k].data();
    a.image[k] = assembly.bodies.images[k].data();
  }
  a.row_of_owner = bodies.row_of_owner.data();
  a.resultants = assembly.pairs.on_members.data();
  return a;
}

}  // namespace

BodySweep::BodySweep(const Model& model, const Assembly& assembly, bool at_rate, KernelDamping damping)
    : model_(model), at_rate_(at_rate) {
  constants_.damping = damping;
  if (!model.bodies) return;
  const std::size_t padded = assembly.bodies.motion.size();
  for (Buffer* column : {&mass_, &inverse_mass_, &inverse_inertia_}) column->assign(padded, 0);
  for (std::size_t b = 0; b < model.bodies->size(); ++b) {
    mass_[b] = mass_of(*model.bodies, assembly, b);
    inverse_mass_[b] = 1 / mass_[b];
    inverse_inertia_[b] = assembly.inverse_inertia[std::size_t(model.bodies->first[b])];
  }
}

void BodySweep::set_step(const StepConstants& c, const Matrix3& inverse_stretch, const Matrix3& gradient,
                         const Vector3& mean_spin_before, const Vector3& mean_spin) {
  constants_.inverse_stretch = upper_triangle(inverse_stretch);
  constants_.gradient = upper_triangle(gradient);
  for (int k = 0; k < 3; ++k) {
    constants_.mean_spin_before[k] = mean_spin_before[k];
    constants_.mean_spin[k] = mean_spin[k];
  }
  constants_.frame_turns = false;
  if (!at_rate_ || model_.dimension() == 2) return;
  const Matrix3 back = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(c.spin_map);
  constants_.frame_turns = !back.isIdentity(0);
  const Turn turn = turn_of(back);
  constants_.frame_back[0] = turn.w;
  for (int k = 0; k < 3; ++k) constants_.frame_back[k + 1] = turn.v[k];
}

void BodySweep::move(const StepConstants& c, const GrainArrays& grains, const PairArrays& pairs, Assembly& assembly,
                     StepSums& sums) {
  BodyMotions& bodies = assembly.bodies;
  BodyArrays arrays = arrays_of_bodies(*model_.bodies, assembly);
  arrays.mass = mass_.data();
  arrays.inverse_mass = inverse_mass_.data();
  arrays.inverse_inertia = inverse_inertia_.data();
  sweep_bodies(model_.kernels_at(assembly.state.last_step.loading), at_rate_, c, constants_, grains, pairs, arrays,
               long(bodies.motion.size()), long(assembly.mass.size()), model_.sharing(), sums);
  // What pads the lanes loses the mean velocity too, step after step.
  std::fill(bodies.motion.begin() + std::ptrdiff_t(model_.bodies->size()), bodies.motion.end(), BodyMotion{});
}

void set_member_velocities(const Model& model, Assembly& assembly) {
  const Matrix3 rate = assembly.state.last_step.rate;
  const Vector3 cell_spin = 0.5 * Vector3(-rate(1, 2), rate(0, 2), -rate(0, 1));
  for (std::size_t g = 0; g < model.size(); ++g) {
    const BodyMotion& m = assembly.bodies.motion[std::size_t(model.bodies->owner[g])];
    const Vector3 arm = assembly.bodies.arm(g);
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
