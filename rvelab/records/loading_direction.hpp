// The direction of strain in which a test goes on, from its records.
#pragma once

#include <span>

#include "rvelab/records/record.hpp"

namespace rvelab::records {

/// Symmetric part of dF F^-1, laboratory frame, of the last 0.5 % of the driving strain in the stage of the last
/// record, less where the stage began or turned since: records scatter, and a single increment does not tell the
/// direction. Zero where that stage has no two records with different strains.
Matrix3 loading_direction(std::span<const Record> records);

}  // namespace rvelab::records
