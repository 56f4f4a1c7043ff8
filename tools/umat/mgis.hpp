// The generic interface of MFront, by which hosts of MGIS call a material: its arguments and entry points.
//
// Layout, values of K[0] to K[2] and symbols are those that MGIS publishes (MGIS/Behaviour/BehaviourDataView.hxx and
// StateView.hxx, src/BehaviourDescription.cxx of MFrontGenericInterfaceSupport), version 1 of the interface: MGIS
// 1.2.2, and 2.0 and later. Nothing of MGIS or TFEL is needed to build or to run this.
#pragma once

namespace umat::mgis {

/// A state, of the start of a step (Real = const double) or of its end.
template <class Real>
struct StateOf {
  const double* gradients;     ///< F: 11 22 33 12 21 13 31 23 32; or strain: 11 22 33 12 13 23, shear times sqrt(2)
  Real* thermodynamic_forces;  ///< stress, Pa; symmetric ones 11 22 33 12 13 23, shear times sqrt(2)
  const double* mass_density;  ///< of the reference configuration
  const double* material_properties;
  Real* internal_state_variables;
  Real* stored_energy;
  Real* dissipated_energy;
  const double* external_state_variables;
};

/// One material point and one step.
struct PointData {
  char* error_message;  ///< null, or room for 512 characters
  double dt;
  double* K;    ///< in: K[0] the request, K[1] stress, K[2] tangent; out: the tangent, row by row
  double* rdt;  ///< factor on the step that the host may take next
  double* speed_of_sound;
  StateOf<const double> s0;
  StateOf<double> s1;
};

/// The kinematics of a behaviour.
enum class Kinematics { small_strain, deformation_gradient };

/// One call: 1, done; 0, done, but the specimen is not in equilibrium; -1, failed: state unchanged, rdt smaller if a
/// smaller step may succeed. The text of 0 and -1 is in error_message. Planes (2) have 4 symmetric and 5 other
/// components, space (3) 6 and 9.
int integrate(Kinematics kinematics, int dimension, PointData* data) noexcept;

}  // namespace umat::mgis
