// The present loading direction (strain) of a test, from its records.
#pragma once

#include <span>

#include "rvelab/records/record.hpp"

namespace rvelab::records {

/// Symmetric part of dF F^-1, laboratory frame, of the last 0.5 % of the driving strain in the stage of the last
/// record, or since the start of the stage or its last reversal if that is shorter: records scatter, so a single
/// increment does not give the direction. Zero if the stage has no two records with different strains.
Matrix3 loading_direction(std::span<const Record> records);

}  // namespace rvelab::records
