// Settings of the kinds of stages, as a protocol gives them; the table of the kinds is stage_kinds.hpp. Pressures are
// compression positive; strains are dimensionless and count from the start of their stage. A kind whose settings nobody
// else asks for may keep them in its own file.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "rvelab/cell/cell.hpp"

namespace rvelab::protocol {

/// All normal stresses to -pressure. Ends when every stress that is driven is within stress_tolerance of its target
/// and the unbalanced ratio is below `unbalanced`; Error if that is not reached within max_rounds.
struct IsotropicStage {
  double pressure = 0;             ///< Pa, > 0
  bool shear_stress_free = false;  ///< false: shear strains stay zero (the cell keeps its angles); true: shear
                                   ///< stresses are driven to zero
  double stress_tolerance = 1e-4;  ///< of the pressure
  double unbalanced = 1e-5;
  double largest_change = 0.1;  ///< of the pressure, in one increment
  long max_rounds = 100;        ///< of relaxing and correcting, at the end
  long max_steps = 1'000'000;   ///< of one relaxation
  bool record = false;          ///< records the state at the start and at the end
};

/// How the driving strain of compression and simple shear goes: to its end, or to and fro.
struct Cycles {
  long count = 0;  ///< 0: straight to to_strain; else the strain goes to to_strain, to -to_strain, ... and ends at 0 on
                   ///< its way back from the last of 2 count turns
  double reverse_at = 0;  ///< Pa, > 0: it turns already where the driving stress has this size (stress-controlled)
};

/// One axis shortened (or lengthened) to a strain 1 - F_aa, with records at fixed strains.
struct CompressionStage {
  enum class Lateral {
    constant_stress,  ///< each lateral normal stress held at -lateral_pressure; shear strains zero
    constant_volume,  ///< det F = 1 with equal lateral strains; shear strains zero
    zero_strain       ///< oedometer: nothing but the axis moves
  };
  std::string axis;      ///< "x", "y", "z"; empty: y in 2D, z in 3D
  double to_strain = 0;  ///< 1 - F_aa, compression positive, below 1, not 0
  double record_every = 5e-4;
  Lateral lateral = Lateral::constant_stress;
  double lateral_pressure = 0;  ///< Pa
  Cycles cycles;                ///< driving stress: axial less mean lateral, compression positive
};

/// Simple shear dv_a/dx_b in a plane "ab" with records at fixed gamma = F_ab.
struct SimpleShearStage {
  enum class Normal {
    constant_volume,  ///< only the shear moves
    constant_stress   ///< sigma_bb held at -normal_pressure by F_bb
  };
  std::string plane;     ///< "xy", "xz", "yz", "yx", "zx", "zy"; empty: xy in 2D, xz in 3D
  double to_strain = 0;  ///< gamma, either sign, not 0
  double record_every = 1e-3;
  Normal normal = Normal::constant_volume;
  double normal_pressure = 0;  ///< Pa
  Cycles cycles;               ///< driving stress: sigma_ab
};

/// A row of a path: A : d eps + B : d sigma = c, as a quantity with a name whose value goes from point to point.
struct PathRow {
  std::string name;
  Matrix3 strain = Matrix3::Zero();  ///< A, symmetric; dimensionless, or Pa where B is not zero
  Matrix3 stress = Matrix3::Zero();  ///< B, symmetric, dimensionless
  std::vector<double> to;            ///< value at each point of the path, in the unit of the row (1 or Pa); empty: it
                                     ///< keeps the value that it has at the start of the stage
  double from = std::numeric_limits<double>::quiet_NaN();  ///< where the way to the first point begins; NaN: at the
                                                           ///< value of the start of the stage
  bool in_stress() const { return !stress.isZero(0); }
};

/// Piecewise linear targets of named rows, quasi-static. The value of a row is A : E + B : sigma, tension positive,
/// with E the sum of the symmetric displacement gradients since the start of the stage (for straight paths the
/// logarithmic strain). Strain that no row names stays zero. Where the rows say that the volume stays, det F stays to
/// round-off.
struct PathStage {
  std::vector<PathRow> rows;
  long points = 1;              ///< of every row that has targets
  long records_per_point = 20;  ///< records, and increments, on the way to each point
  long cycles = 1;              ///< times that the points are gone through
  std::string axis;             ///< loading axis for the records; may be empty
  bool isotropic = false;       ///< the driving strain is the volumetric one, 1 - det F
};

/// Deviatoric loading at constant mean stress: eps_q is driven along a fixed direction of the deviatoric plane, the
/// deviator of stress across it stays as it is, zero at isotropic stress (3D: constant Lode angle), p is held from the
/// first record after the start on, shear strains are zero.
struct DeviatoricStage {
  double lode_angle_deg = 0;  ///< 3D: 0 compression along z, 60 extension along y; principal axes x, y, z
  double to_strain = 0;       ///< eps_q, > 0; 2D: along (x, -y), compression along y
  double record_every = 1e-3;
  double pressure = 0;  ///< Pa
};

/// Isotropic compression and swelling: all normal stresses go from pressure to pressure, shear strains are zero.
struct PressurePathStage {
  std::vector<double> pressures;  ///< Pa, > 0
  long records_per_point = 5;
};

/// A constant gradient: F goes as exp(s gradient), s the driving strain. Physical loading: velocity gradient = rate x
/// gradient.
struct FlowStage {
  Matrix3 gradient = Matrix3::Zero();
  double to_strain = 0;  ///< s at the end, > 0
  double record_every = 1e-3;
};

/// A given history of deformation gradients F, rotation included, one record at each.
struct DeformationStage {
  std::vector<Matrix3> gradients;
};

/// Response envelope: the same size of probe in every direction of a plane of strain or stress, each from the state as
/// it is, which the test then goes on from. Each probe is a record, the state before them the first.
struct EnvelopeStage {
  bool stress_probes = false;  ///< false: strain prescribed; true: stress
  double size = 1e-4;          ///< strain: norm of dE
  double stress_size = 0;      ///< Pa, norm of d sigma
  long directions = 24;
  long increments = 1;       ///< of each probe
  double unbalanced = 1e-5;  ///< at which each ends, at fixed cell
  long max_steps = 1'000'000;
};

/// Quasi-static steps at fixed cell. Error if the unbalanced ratio is not reached.
struct RelaxStage {
  double unbalanced = 1e-5;
  long max_steps = 1'000'000;
  bool record = false;
};

/// Smallest strain of a probe: the stress is a sum of some hundred forces and known to some 1e-16 of p, so that a
/// stiffness of some hundred p is off by a thousandth here and by a fifth at 1e-14.
inline constexpr double smallest_probe = 1e-12;

/// The stiffness of the state at small strain, measured on a copy: the test goes on from the state as it was.
struct ProbeStage {
  enum class Method {
    dynamic,  ///< increments of +-size, relaxed (probe_stiffness)
    linear,   ///< the contact network solved, every contact stuck (elastic_tangent); size and no_slip mean nothing
    loading   ///< increments that go on in the direction of the records before (loading_stiffness)
  };
  double size = 1e-7;    ///< strain of a dynamic or loading probe
  bool no_slip = false;  ///< friction 1e6 in the probed copy
  Method method = Method::dynamic;
};

/// What calibration reads from the records of a stage.
struct StageRole {
  enum class Gives {
    nothing,
    strength,             ///< drained compression: a friction angle
    oedometric_stiffness  ///< one axis shortened, nothing else moves
  } gives = Gives::nothing;
  std::string axis;  ///< that is shortened: "x", "y", "z"; empty: y in 2D, z in 3D
};

}  // namespace rvelab::protocol
