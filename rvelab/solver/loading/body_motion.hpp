// The step of bodies (clumps), in place of that of grains (kernels/integrate.hpp): forces and moments of the members
// are gathered, the body is damped and moves, the members are placed from it (kernels/bodies.hpp, body_members.hpp).
//
//   v' as of grains, with the mass of the body
//   quasi-static: w' <- w' + T/I with one scaled I for all axes; at a rate: L <- L + dt T, then free rotation for dt
//   (grains/rigid_motion.hpp), so that |L| and energy of a body that nothing touches are kept to round-off
//   x_g = c + R o_g
//   v'_g = v' + B^-1 (w x o) - G o0: what moves the member as x <- A x + dt B v'_g would, so that contacts slip and
//   open by exactly what its place says; o0 and o are the arms before the step and in its middle, w the spin in the
//   cell frame, G = L0 Lm^-1 (L1 - L0)/dt L0^-1
//
// Cundall's damping acts on the resultant force by the velocity of the centre and on the torque by the spin; of its two
// forms `vector` does not depend on the axes.
#pragma once

#include "rvelab/solver/assembly/assembly.hpp"

namespace rvelab {

/// The bodies of one Advance.
class BodySweep {
 public:
  /// With the masses in use, which must stay.
  BodySweep(const Model& model, const Assembly& assembly, bool at_rate, KernelDamping damping);
  /// `gradient`: G (1/s); `inverse_stretch`: B^-1 = L0 Lm^-1; spins: axial(W + Omega) of the sub-step before and of
  /// this one (rad/s).
  void set_step(const StepConstants& constants, const Matrix3& inverse_stretch, const Matrix3& gradient,
                const Vector3& mean_spin_before, const Vector3& mean_spin);
  void move(const StepConstants& constants, const GrainArrays& grains, const PairArrays& pairs, Assembly& assembly,
            StepSums& sums);

 private:
  const Model& model_;
  Buffer mass_, inverse_mass_, inverse_inertia_;  ///< padded
  BodyConstants constants_;
  bool at_rate_;
};

/// v' + shift f/m and the like of spins, where the half step changes; members follow.
void shift_bodies(const Model& model, double shift, Assembly& assembly);
/// Velocities of members from those of their bodies as they stand.
void set_member_velocities(const Model& model, Assembly& assembly);
void stop_bodies(Assembly& assembly);

/// J, and Reynolds stress times volume (N m), with the masses in use.
double kinetic_energy_of_bodies(const Model& model, const Assembly& assembly);
Matrix3 reynolds_of_bodies(const Model& model, const Assembly& assembly);

}  // namespace rvelab
