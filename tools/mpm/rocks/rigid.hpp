// A rigid body that moves freely (Li et al. 2023, eq. 13, 14): mass, inertia, position, orientation, velocity, angular
// momentum.
//
//   m dv/dt = f,  dL/dt = t,  w = R I^-1 R^T L
//
// Leap-frog: half a kick, a drift, half a kick. A drift turns a sphere about its spin, another body about its principal
// axes, each at the rate that the angular momentum has along it (x/2, y/2, z, y/2, x/2): L stays as it is to the bit, R
// a rotation.
#pragma once

#include "tools/mpm/shapes/shape.hpp"

namespace mpm {

/// r x f; in the plane its part across the plane.
template <int D>
Spin<D> moment(const Vec<D>& r, const Vec<D>& f) {
  if constexpr (D == 2) {
    return Spin<2>(r[0] * f[1] - r[1] * f[0]);
  } else {
    return r.cross(f);
  }
}

/// w x r, the velocity at r by the spin w.
template <int D>
Vec<D> spun(const Spin<D>& w, const Vec<D>& r) {
  if constexpr (D == 2) {
    return Vec<2>(-w[0] * r[1], w[0] * r[0]);
  } else {
    return w.cross(r);
  }
}

template <int D>
Rot<D> unturned() {
  if constexpr (D == 2) {
    return 0.0;
  } else {
    return Eigen::Quaterniond::Identity();
  }
}

template <int D>
struct Rigid {
  double mass = 0;                             ///< kg
  Spin<D> inertia = Spin<D>::Ones();           ///< kg m^2, about the principal axes
  Vec<D> centre = Vec<D>::Zero();              ///< m
  Rot<D> orientation = unturned<D>();          ///< of the principal axes
  Vec<D> velocity = Vec<D>::Zero();            ///< m/s
  Spin<D> angular_momentum = Spin<D>::Zero();  ///< kg m^2/s, about the centre, along the axes of space
  Vec<D> free = Vec<D>::Ones();                ///< by axis: 1, or 0 where its velocity is held
  bool turns = true;                           ///< false: its spin is held

  /// Equal moments of inertia, as those of a sphere or a cube: the spin is along the angular momentum.
  bool isotropic() const {
    if constexpr (D == 2) {
      return true;
    } else {
      return inertia[0] == inertia[1] && inertia[1] == inertia[2];
    }
  }
  /// rad/s
  Spin<D> spin() const {
    if constexpr (D == 3) {
      if (!isotropic()) return orientation * (orientation.conjugate() * angular_momentum).cwiseQuotient(inertia);
    }
    return angular_momentum / inertia[0];
  }
  void set_spin(const Spin<D>& spin) {
    if constexpr (D == 2) {
      angular_momentum = inertia[0] * spin;
    } else {
      angular_momentum = orientation * (orientation.conjugate() * spin).cwiseProduct(inertia);
    }
  }
  /// m/s, of the body at a distance r from its centre.
  Vec<D> velocity_at(const Vec<D>& r) const { return velocity + spun<D>(spin(), r); }
  /// J
  double kinetic() const { return 0.5 * mass * velocity.squaredNorm() + 0.5 * angular_momentum.dot(spin()); }
  void kick(const Vec<D>& force, const Spin<D>& torque, double dt) {
    velocity += (dt / mass) * force.cwiseProduct(free);
    if (turns) angular_momentum += dt * torque;
  }
  void drift(double dt) {
    centre += dt * velocity;
    turn(dt);
  }
  /// Change of the velocity at `at` for an impulse at `r`, both from the centre, m/s of N s.
  Mat<D> mobility(const Vec<D>& at, const Vec<D>& r) const {
    Mat<D> change = (free / mass).asDiagonal();
    for (int i = 0; turns && i < D; ++i) change.col(i) += spun<D>(spin_of(moment<D>(r, Vec<D>::Unit(i))), at);
    return change;
  }
  /// rad/s, of an angular impulse (N m s).
  Spin<D> spin_of(const Spin<D>& impulse) const {
    if (!turns) return Spin<D>::Zero();
    if constexpr (D == 3) {
      if (!isotropic()) return orientation * (orientation.conjugate() * impulse).cwiseQuotient(inertia);
    }
    return impulse / inertia[0];
  }

 private:
  void turn(double dt) {
    if constexpr (D == 2) {
      orientation += dt * angular_momentum[0] / inertia[0];
    } else if (!turns || isotropic()) {
      const Vec<3> rate = spin();
      const double speed = rate.norm();
      if (!(speed > 0)) return;
      orientation = Eigen::Quaterniond(Eigen::AngleAxisd(dt * speed, rate / speed)) * orientation;
      orientation.normalize();
      if (!isotropic()) set_spin(rate);
    } else {
      const auto about = [&](int axis, double part) {
        const double momentum = (orientation.conjugate() * angular_momentum)[axis];
        const double angle = part * dt * momentum / inertia[axis];
        orientation = orientation * Eigen::Quaterniond(Eigen::AngleAxisd(angle, Vec<3>::Unit(axis)));
      };
      about(0, 0.5);
      about(1, 0.5);
      about(2, 1);
      about(1, 0.5);
      about(0, 0.5);
      orientation.normalize();
    }
  }
};

}  // namespace mpm
