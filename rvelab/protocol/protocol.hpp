// A test as data: stages of loading, read from a TOML file and checked whole before anything runs.
//
// This room knows what a laboratory test is (stages, targets, what is recorded); it reaches grains only through
// Rve::apply and Rve::relax and knows no file but the protocol. Pressures are compression positive; strains are
// dimensionless and count from the start of their stage.
#pragma once

#include <toml++/toml.h>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "rvelab/records/record.hpp"
#include "rvelab/solver/specimen.hpp"

namespace rvelab {

/// How driven stages (compression, simple shear, flow) pass through time. All other stages are quasi-static.
struct Loading {
  bool physical = false;          ///< false: dt = 0; true: physical masses at the rate below
  double rate = 0;                ///< 1/s, true rate of the driving strain; 0: from the inertial number
  double inertial_number = 0;     ///< I = rate d sqrt(rho/p), p at the start of the stage; 0: from the rate
  double held_tolerance = 0.005;  ///< a held stress may miss by this times max(|target|, 1 % of the stage's first p);
                                  ///< physical: its mean over an increment may
  static constexpr double held_tolerance_at_rate =
      0.05;              ///< where a protocol does not say: collisions make it fluctuate
  long held_wait = 200;  ///< quasi-static: sub-steps that a record waits for it, see MixedTarget::wait
};

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

/// The stiffness of the state at small strain, measured on a copy: the test goes on from the state as it was.
struct ProbeStage {
  enum class Method {
    dynamic,  ///< increments of +-size, relaxed (probe_stiffness)
    linear    ///< the contact network solved, every contact stuck (elastic_tangent); size and no_slip mean nothing
  };
  double size = 1e-7;    ///< strain of a dynamic probe
  bool no_slip = false;  ///< friction 1e6 in the probed copy
  Method method = Method::dynamic;
};

/// What ends a stage before its end: looked at with each of its records but the first.
struct Event {
  enum class When { above, below, falls_by };
  std::string quantity;  ///< see event_quantities()
  When when = When::above;
  double value = 0;  ///< of the quantity; falls_by: fraction that it has lost of the largest it had in this stage
  std::string then;  ///< name of the stage to go on with; empty: the next; "end": none
};

struct Stage {
  std::string name;  ///< the kind, unless the file names it
  std::variant<IsotropicStage, CompressionStage, SimpleShearStage, RelaxStage, ProbeStage, PathStage, DeviatoricStage,
               PressurePathStage, FlowStage, DeformationStage, EnvelopeStage>
      what;
  std::vector<Event> until;
  std::string then;  ///< after its own end; empty: the next; "end": none
};

/// A checked protocol.
struct Protocol {
  std::string path;  ///< of its file; relative names in it count from there
  std::string name;
  int dimension = 0;                                           ///< 2 or 3; 0: any
  double pressure = std::numeric_limits<double>::quiet_NaN();  ///< Pa, [test] pressure_Pa
  bool uses_pressure = false;                                  ///< a stage takes its pressure from there
  std::string specimen_file;                                   ///< empty: given on the command line
  std::vector<double> calibration_pressures;                   ///< Pa, [calibrate] pressures_Pa
  toml::table overrides;                                       ///< [contact], [damping], [solver], [material]
  Loading loading;
  long snapshots_every = 0;  ///< [output]: grains and contacts are kept at every so many records; 0: never
  std::uint64_t quantities = usual_quantities;  ///< [output]: what is measured at each record (record.hpp)
  std::vector<Stage> stages;
  std::string resolved;  ///< the protocol with every default and assignment in it, TOML
};

/// Reads a protocol file after the assignments "key=value" have been applied to it ("test.pressure_Pa=2e4",
/// "contact.slip=full_radius", "stage.compression.to_strain=0.05"; stages by name or by number from 0). A value is
/// TOML; what is not is taken as text. Throws InputError with every mistake of the file: unknown keys (with the
/// nearest known one), missing ones, wrong types, values out of range, keys that contradict each other, each with its
/// line.
Protocol read_protocol(const std::string& path, const std::vector<std::string>& assignments = {});

/// The same from a text; `path` serves messages and relative names only.
Protocol parse_protocol(const std::string& text, const std::string& path,
                        const std::vector<std::string>& assignments = {});

/// The specimen with the protocol's overrides. InputError if one does not fit the specimen (a material that it has
/// not, a stiffness key that its law does not take), or if its dimension is not the protocol's.
Specimen with_overrides(const Protocol& protocol, Specimen specimen);

}  // namespace rvelab
