// Symbols of a behaviour that MGIS and TFEL read before they call it: one for each property, with C linkage.
//
// A new behaviour is a row below. Empty lists need their symbol, too.
#include "rvelab/io/version.hpp"
#include "tools/umat/mgis.hpp"

#define RVELAB_EXPORT extern "C" [[gnu::visibility("default")]]
#define RVELAB_TEXT(behaviour, name, ...) RVELAB_EXPORT const char* const behaviour##_##name = __VA_ARGS__
#define RVELAB_NUMBER(behaviour, name, value) RVELAB_EXPORT const unsigned short behaviour##_##name = value
#define RVELAB_TEXTS(behaviour, name, ...) RVELAB_EXPORT const char* const behaviour##_##name[] = {__VA_ARGS__}
#define RVELAB_TYPES(behaviour, name, ...) RVELAB_EXPORT const int behaviour##_##name[] = {__VA_ARGS__}
#define RVELAB_ENTRY(behaviour, hypothesis, kinematics, dimension)                     \
  RVELAB_EXPORT int behaviour##_##hypothesis(umat::mgis::PointData* data) noexcept {   \
    return umat::mgis::integrate(umat::mgis::Kinematics::kinematics, dimension, data); \
  }

// Types of variables: 0 scalar, 1 symmetric tensor, 3 tensor. Kinds: 1 small strain, 2 finite strain. Kinematics: 1
// small strain and stress, 3 F and Cauchy stress. Symmetry 0: the host does not rotate into material axes, since the
// axes of an RVE are those of space.
#define RVELAB_BEHAVIOUR(name, kind, kinematic, gradient, gradient_type, kinematics)          \
  RVELAB_TEXT(name, mfront_ept, #name);                                                       \
  RVELAB_NUMBER(name, mfront_mkt, 1);                                                         \
  RVELAB_TEXT(name, mfront_interface, "Generic");                                             \
  RVELAB_TEXT(name, mfront_law, #name);                                                       \
  RVELAB_TEXT(name, mfront_material, "");                                                     \
  RVELAB_NUMBER(name, api_version, 1);                                                        \
  RVELAB_TEXT(name, tfel_version, "");                                                        \
  RVELAB_TEXT(name, unit_system, "SI");                                                       \
  RVELAB_TEXT(name, src, "rvelab");                                                           \
  RVELAB_TEXT(name, author, "The rvelab authors");                                            \
  RVELAB_TEXT(name, date, "");                                                                \
  RVELAB_TEXT(name, validator, "");                                                           \
  RVELAB_TEXT(name, build_id, rvelab::io::version);                                           \
  RVELAB_NUMBER(name, BehaviourType, kind);                                                   \
  RVELAB_NUMBER(name, BehaviourKinematic, kinematic);                                         \
  RVELAB_NUMBER(name, SymmetryType, 0);                                                       \
  RVELAB_NUMBER(name, ElasticSymmetryType, 0);                                                \
  RVELAB_NUMBER(name, nModellingHypotheses, 3);                                               \
  RVELAB_TEXTS(name, ModellingHypotheses, "Axisymmetrical", "PlaneStrain", "Tridimensional"); \
  RVELAB_NUMBER(name, nMainVariables, 1);                                                     \
  RVELAB_NUMBER(name, nGradients, 1);                                                         \
  RVELAB_TEXTS(name, Gradients, gradient);                                                    \
  RVELAB_TYPES(name, GradientsTypes, gradient_type);                                          \
  RVELAB_NUMBER(name, nThermodynamicForces, 1);                                               \
  RVELAB_TEXTS(name, ThermodynamicForces, "Stress");                                          \
  RVELAB_TYPES(name, ThermodynamicForcesTypes, 1);                                            \
  RVELAB_NUMBER(name, nTangentOperatorBlocks, 2);                                             \
  RVELAB_TEXTS(name, TangentOperatorBlocks, "Stress", gradient);                              \
  RVELAB_NUMBER(name, nMaterialProperties, 2);                                                \
  RVELAB_TEXTS(name, MaterialProperties, "Material", "PhysicalTime");                         \
  RVELAB_NUMBER(name, nInternalStateVariables, 2);                                            \
  RVELAB_TEXTS(name, InternalStateVariables, "RveId", "RveToken");                            \
  RVELAB_TYPES(name, InternalStateVariablesTypes, 0, 0);                                      \
  RVELAB_NUMBER(name, TemperatureRemovedFromExternalStateVariables, 0);                       \
  RVELAB_NUMBER(name, nExternalStateVariables, 0);                                            \
  RVELAB_TEXTS(name, ExternalStateVariables, nullptr);                                        \
  RVELAB_TYPES(name, ExternalStateVariablesTypes, 0);                                         \
  RVELAB_NUMBER(name, nParameters, 0);                                                        \
  RVELAB_TEXTS(name, Parameters, nullptr);                                                    \
  RVELAB_TYPES(name, ParametersTypes, 0);                                                     \
  RVELAB_NUMBER(name, nInitializeFunctions, 0);                                               \
  RVELAB_NUMBER(name, nPostProcessings, 0);                                                   \
  RVELAB_NUMBER(name, requiresStiffnessTensor, 0);                                            \
  RVELAB_NUMBER(name, requiresThermalExpansionCoefficientTensor, 0);                          \
  RVELAB_NUMBER(name, UsableInPurelyImplicitResolution, 1);                                   \
  RVELAB_NUMBER(name, ComputesInternalEnergy, 0);                                             \
  RVELAB_NUMBER(name, ComputesDissipatedEnergy, 0);                                           \
  RVELAB_ENTRY(name, Axisymmetrical, kinematics, 2)                                           \
  RVELAB_ENTRY(name, PlaneStrain, kinematics, 2)                                              \
  RVELAB_ENTRY(name, Tridimensional, kinematics, 3)

RVELAB_BEHAVIOUR(GranularRve, 2, 3, "DeformationGradient", 3, deformation_gradient)
RVELAB_BEHAVIOUR(GranularRveSmallStrain, 1, 1, "Strain", 1, small_strain)
