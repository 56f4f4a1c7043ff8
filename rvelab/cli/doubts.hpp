// What a test's records are doubtful for, told on standard error.
#pragma once

#include <vector>

#include "rvelab/protocol/run.hpp"

namespace rvelab::cli {

/// How many records are doubtful, and why.
struct Doubtful {
  long not_held = 0, not_quasi_static = 0, either = 0, thin = 0;
  long without_pressure = 0;  ///< of either: p is below 5 % of that of the first record
};

Doubtful doubtful_of(const std::vector<records::Record>& records, int dimension);

/// Values that are likely in another unit, each key once in the life of the program. `file`: that holds them.
void tell_of_units(const std::string& file, const std::vector<std::string>& doubts);

/// Before the test: stages whose shear makes the cell thin.
void tell_of_shear(const protocol::Protocol& protocol, const Specimen& specimen);

/// After it: records that are doubtful or of a thin cell, waiting for held stresses, a cell that became low.
void warn_records(const Specimen& specimen, const protocol::TestRun& run, const Doubtful& doubtful);

}  // namespace rvelab::cli
