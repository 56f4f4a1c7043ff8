// One row of a test: what is written at each recorded strain, and the table of a whole test.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

#include "rvelab/cell/cell.hpp"

namespace rvelab {

/// A recorded state. Laboratory frame; stress tension positive. Strains count from the start of the stage.
struct Record {
  int stage = 0;
  double strain = 0;  ///< the stage's driving strain: axial (compression positive, 1 - F_aa), or gamma
  Matrix3 deformation_gradient = Matrix3::Identity();  ///< F since the start of the stage
  Matrix3 stress = Matrix3::Zero();                    ///< Cauchy, Pa
  double void_ratio = 0;
  double coordination_number = 0;
  double fabric_anisotropy = 0;
  double sliding_fraction = 0;
  double unbalanced_force_ratio = 0;
  double inertial_number = 0;
  long substeps = 0;        ///< made since the record before
  double held_error = 0;    ///< largest error of a held stress over its scale
  bool target_held = true;  ///< false: kept, but the held stress was not within the tolerance after the wait
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
  std::string axis;      ///< loading axis: "x", "y", "z", or "xy" / "xz" for simple shear
  double pressure = std::numeric_limits<double>::quiet_NaN();  ///< Pa, the stage's first p (held lateral stress)
  std::vector<std::string> stages;                             ///< names, in order
  std::vector<Record> records;
  std::vector<ProbeResult> probes;
  double wall_seconds = 0;
  unsigned long long grain_steps = 0;
};

}  // namespace rvelab
