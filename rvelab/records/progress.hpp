// The progress of a test between two increments: with the specimen, all data needed to continue it bitwise.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "rvelab/specimen/specimen.hpp"

namespace rvelab::records {

/// Scalars of a running test. Laboratory frame, SI; strains count from the start of the stage.
struct Progress {
  std::int32_t stage = 0;             ///< row of the current stage; the number of stages at the end
  std::int32_t phase = 0;             ///< of that stage; 0: not begun, others: see the drive of its kind
  std::int64_t step = 0;              ///< of that phase: records, increments or rounds made
  std::int64_t relaxation_steps = 0;  ///< sub-steps of the current relaxation; 0: no relaxation
  std::int64_t substeps = 0;          ///< since the last record
  std::int64_t records = 0, probes = 0;
  double unbalanced_ratio = 0;                ///< after the last round of an isotropic stage
  double first_pressure = 0;                  ///< Pa, p at the start of the stage
  double rate = 0;                            ///< 1/s, of the stage's driving strain; 0 when quasi-static
  Matrix3 deformation = Matrix3::Identity();  ///< F since the start of the stage
  Matrix3 stress = Matrix3::Zero();           ///< Pa
  Matrix3 strain_sum = Matrix3::Zero();       ///< of the symmetric displacement gradients since the start of the stage
  Matrix3 first_stress = Matrix3::Zero();     ///< Pa, at the start of the stage
  std::int64_t turns = 0;                     ///< cyclic stages: reversals of the driving strain so far
  std::int64_t place = 0;                     ///< cyclic stages: driving strain over the spacing of records
  std::vector<std::int64_t> visits;           ///< times that each stage of the protocol was begun
  std::vector<double> largest;                ///< largest value of each event's quantity in this stage
  std::string axis;                           ///< of the result so far
  double pressure = std::numeric_limits<double>::quiet_NaN();  ///< Pa, of the result so far
  std::uint64_t first_grain_steps = 0;                         ///< the specimen's count when the test began
  double wall_seconds = 0;                                     ///< so far
};

/// An unfinished test.
struct Checkpoint {
  Progress progress;
  Specimen specimen;
};

}  // namespace rvelab::records
