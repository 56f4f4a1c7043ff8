// One row of a test, written at each recorded strain, and the table of a whole test.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "rvelab/cell/cell.hpp"
#include "rvelab/records/quantities.hpp"

namespace rvelab::records {

/// Common to all records. Laboratory frame; stress tension positive. Strains count from the start of the stage.
struct RecordedState {
  std::int32_t stage = 0;  ///< row of the protocol's stages
  double strain = 0;       ///< the stage's driving strain: axial (compression positive, 1 - F_aa), gamma, ... (README)
  Matrix3 deformation_gradient = Matrix3::Identity();  ///< F since the start of the stage
  Matrix3 stress = Matrix3::Zero();                    ///< Cauchy, Pa
  double unbalanced_force_ratio = 0;
  double inertial_number = 0;
  long substeps = 0;         ///< made since the record before
  double held_error = 0;     ///< largest error of a held stress over its scale
  bool target_held = true;   ///< false: kept, but the held stress was not within the tolerance (at a rate)
  bool quasi_static = true;  ///< false: kept, but not in equilibrium (Report::in_equilibrium); at a rate: always true

  double error_estimate = 0;  ///< Report::error_estimate over p; 0: not judged (at a rate, no increment, no pressure)

  bool cell_thin = false;  ///< a cell height is below four mean diameters: the record is less representative

  std::uint64_t quantities = usual_quantities;  ///< bits of the measured ones
};

/// A recorded state with its quantities (quantities.hpp), each a member by its name; those that were not requested are
/// zero.
struct Record : RecordedState, Quantities {};

/// Result of a probe stage: stiffness in the form of elastic_tangent() (rvelab/measure/tangent.hpp), Pa; 3x3 in 2D, 6x6
/// in 3D.
struct ProbeResult {
  std::string stage;  ///< its name
  Eigen::MatrixXd stiffness;
};

/// A test that was run: its records in order, and its description.
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

/// Measures the quantities of record.quantities at the state of an Rve.
inline void measure_quantities(Record& record, const Rve& rve) {
  if (record.quantities == 0) return;
  const MeasuredState state(rve);
  Quantities::for_each([&]<class Quantity>(std::type_identity<Quantity>, std::uint64_t bit) {
    if ((record.quantities & bit) != 0) record.*Quantity::member = Quantity::measure(state);
  });
}

}  // namespace rvelab::records
