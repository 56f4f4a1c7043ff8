// Warnings of a test and its specimen on standard error.
#pragma once

#include <vector>

#include "rvelab/cli/report.hpp"
#include "rvelab/protocol/run.hpp"

namespace rvelab::cli {

/// Numbers of records with a flag.
struct FlaggedRecords {
  long not_held = 0, not_quasi_static = 0, either = 0, thin = 0;
  long without_pressure = 0;  ///< of `either`: p is below 5 % of that of the first record
};

FlaggedRecords flagged_records(const std::vector<records::Record>& records, int dimension);

/// Values that are probably in another unit, each key once per run of the program. `file`: that contains them.
void warn_of_units(const std::string& file, const std::vector<std::string>& warnings);

/// Asks whether millimetres were meant if the grains have diameters of metres and no forces.
void warn_of_sizes(const Sizes& sizes);

/// Before the test: stages whose shear makes the cell thin.
void warn_of_shear(const protocol::Protocol& protocol, const Specimen& specimen);

/// After it: flagged records, waiting for held stresses, a cell that became low.
void warn_records(const Specimen& specimen, const protocol::TestRun& run, const FlaggedRecords& flagged);

}  // namespace rvelab::cli
