// One row of a test: what is written at each recorded strain, and the table of a whole test.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "rvelab/cell/cell.hpp"

namespace rvelab {

/// What may be measured at a record beyond stress and strain: [output] quantities. What is not asked for is neither
/// computed nor in the file.
enum Quantity : std::uint64_t {
  void_ratio_asked = 1,
  coordination_number_asked = 2,
  fabric_anisotropy_asked = 4,
  sliding_fraction_asked = 8,
  mechanical_void_ratio_asked = 16,
  mechanical_coordination_number_asked = 32,
  fabric_asked = 64,
  branch_fabric_asked = 128,
  contact_stress_asked = 256,
  reynolds_stress_asked = 512,
  elastic_energy_asked = 1024,
  kinetic_energy_asked = 2048
};

struct QuantityName {
  Quantity quantity;
  const char* name;  ///< in protocols, and of the dataset under /records
};

inline constexpr QuantityName quantity_names[] = {
    {void_ratio_asked, "void_ratio"},
    {coordination_number_asked, "coordination_number"},
    {fabric_anisotropy_asked, "fabric_anisotropy"},
    {sliding_fraction_asked, "sliding_fraction"},
    {mechanical_void_ratio_asked, "mechanical_void_ratio"},
    {mechanical_coordination_number_asked, "mechanical_coordination_number"},
    {fabric_asked, "fabric"},
    {branch_fabric_asked, "branch_fabric"},
    {contact_stress_asked, "contact_stress_Pa"},
    {reynolds_stress_asked, "reynolds_stress_Pa"},
    {elastic_energy_asked, "elastic_energy_J"},
    {kinetic_energy_asked, "kinetic_energy_J"}};

/// Measured where a protocol does not say.
inline constexpr std::uint64_t usual_quantities =
    void_ratio_asked | coordination_number_asked | fabric_anisotropy_asked | sliding_fraction_asked;

/// A recorded state. Laboratory frame; stress tension positive. Strains count from the start of the stage.
struct Record {
  std::int32_t stage = 0;  ///< row of the protocol's stages
  double strain = 0;       ///< the stage's driving strain: axial (compression positive, 1 - F_aa), gamma, ... (README)
  Matrix3 deformation_gradient = Matrix3::Identity();  ///< F since the start of the stage
  Matrix3 stress = Matrix3::Zero();                    ///< Cauchy, Pa
  double unbalanced_force_ratio = 0;
  double inertial_number = 0;
  long substeps = 0;         ///< made since the record before
  double held_error = 0;     ///< largest error of a held stress over its scale
  bool target_held = true;   ///< false: kept, but the held stress was not within the tolerance (dt = 0: after the wait)
  bool quasi_static = true;  ///< dt = 0; false: kept, but no equilibrium (Report::quasi_static); dt > 0: not judged

  std::uint64_t quantities = usual_quantities;  ///< which of the following were measured; the others are zero
  double void_ratio = 0;
  double coordination_number = 0;
  double fabric_anisotropy = 0;
  double sliding_fraction = 0;
  double mechanical_void_ratio = 0;           ///< rattlers counted as voids
  double mechanical_coordination_number = 0;  ///< without rattlers
  Matrix3 fabric = Matrix3::Zero();           ///< <n (x) n>
  Matrix3 branch_fabric = Matrix3::Zero();    ///< sum b (x) b / sum b.b
  Matrix3 contact_stress = Matrix3::Zero();   ///< Pa
  Matrix3 reynolds_stress = Matrix3::Zero();  ///< Pa; zero when quasi-static
  double elastic_energy = 0;                  ///< J
  double kinetic_energy = 0;                  ///< J, of the fluctuations
};

/// What a probe stage measured: stiffness as elastic_tangent() gives it (rvelab/measure/tangent.hpp), Pa; 3x3 in 2D,
/// 6x6 in 3D.
struct ProbeResult {
  std::string stage;  ///< its name
  Eigen::MatrixXd stiffness;
};

/// A test that was run: its records in order, and what it was.
struct TestResult {
  std::string protocol;  ///< [test] name
  std::string axis;      ///< loading axis: "x", "y", "z", or "xy" / "xz" for simple shear; empty: none
  double pressure = std::numeric_limits<double>::quiet_NaN();  ///< Pa, the stage's first p (held lateral stress)
  std::vector<std::string> stages;                             ///< names of all stages of the protocol
  std::vector<Record> records;
  std::vector<ProbeResult> probes;
  double wall_seconds = 0;
  unsigned long long grain_steps = 0;
};

}  // namespace rvelab
