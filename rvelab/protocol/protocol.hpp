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

#include "rvelab/solver/specimen.hpp"

namespace rvelab {

/// How driven stages (compression, simple shear) pass through time. All other stages are quasi-static.
struct Loading {
  bool physical = false;          ///< false: dt = 0; true: physical masses at the rate below
  double rate = 0;                ///< 1/s, true rate of the driving strain; 0: from the inertial number
  double inertial_number = 0;     ///< I = rate d sqrt(rho/p), p at the start of the stage; 0: from the rate
  double held_tolerance = 0.005;  ///< a held stress may miss by this times max(|target|, 1 % of the stage's first p)
  long held_wait = 200;           ///< sub-steps that a record waits for the held stress
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

/// One axis shortened (or lengthened) to a strain 1 - F_aa, with records at fixed strains.
struct CompressionStage {
  enum class Lateral {
    constant_stress,  ///< each lateral normal stress held at -lateral_pressure; shear strains zero
    constant_volume   ///< det F = 1 with equal lateral strains; shear strains zero
  };
  std::string axis;      ///< "x", "y", "z"; empty: y in 2D, z in 3D
  double to_strain = 0;  ///< 1 - F_aa, compression positive, below 1, not 0
  double record_every = 5e-4;
  Lateral lateral = Lateral::constant_stress;
  double lateral_pressure = 0;  ///< Pa
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

struct Stage {
  std::string name;  ///< the kind, unless the file names it
  std::variant<IsotropicStage, CompressionStage, SimpleShearStage, RelaxStage, ProbeStage> what;
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

/// Applies one assignment to a parsed file. InputError if it has no value, or names no stage that is there.
void assign(toml::table& file, const std::string& assignment);

/// The specimen with the protocol's overrides. InputError if one does not fit the specimen (a material that it has
/// not, a stiffness key that its law does not take), or if its dimension is not the protocol's.
Specimen with_overrides(const Protocol& protocol, Specimen specimen);

}  // namespace rvelab
