// The rows of a path: which constraints they make together, and what they ask at each of its records. Internal to the
// room.
#pragma once

#include <string>
#include <vector>

#include "rvelab/protocol/protocol.hpp"
#include "rvelab/solver/rve.hpp"

namespace rvelab::protocol {

/// The rows and, for every strain component that none of them names (in A or in B), one that keeps it at zero.
std::vector<PathRow> completed(const PathStage& stage, int dimension);

/// What is wrong with the rows as one set of constraints on a specimen of this dimension, in words that name the rows:
/// their number, rows that follow from others, rows that contradict others, rows that leave a strain open. Empty: they
/// are good.
std::string mistake_of_rows(const PathStage& stage, int dimension);

/// A : E + B : sigma.
double row_value(const PathRow& row, const Matrix3& strain_sum, const Matrix3& stress);

/// Value of a row at record `step` (0: the start), in its unit.
double row_target(const PathStage& stage, const PathRow& row, long step, const Matrix3& first_stress);

/// Records after the first.
long path_steps(const PathStage& stage);

/// Combination of the rows of pure strain that is the volumetric strain, one factor a row; empty if there is none.
std::vector<double> volume_factors(const std::vector<PathRow>& rows, int dimension);

/// What an increment adds to the sum of strains: the deviator of the symmetric displacement gradient, and the logarithm
/// of its change of volume.
Matrix3 strain_increment(const Matrix3& displacement_gradient, int dimension);

}  // namespace rvelab::protocol
