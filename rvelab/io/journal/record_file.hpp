// The records of a test as an HDF5 file, R.h5: one dataset a column under /records, what was run under /test, how it
// came about under /provenance, and the end state under /specimen, from which a test can go on
// (rvelab/io/README.md lists them). A running test writes through RecordStore; here is what whole tests need.
#pragma once

#include <string>

#include "rvelab/records/record.hpp"
#include "rvelab/specimen/specimen.hpp"

namespace rvelab::io {

/// Writes a test and its end state, as write_specimen does. `resolved_protocol_text`: the protocol with every default
/// and every --set in it, TOML. Provenance holds no host names and no dates.
void write_records(const records::TestResult& result, const Specimen& end_state,
                   const std::string& resolved_protocol_text, const std::string& path);

/// Reads the records of a record file and its journal, bitwise as they were written. InputError as read_specimen, and
/// if the file holds a specimen only.
records::TestResult read_records(const std::string& path);

/// The resolved protocol of a record file.
std::string read_protocol_text(const std::string& path);

}  // namespace rvelab::io
