// Results of probe stages in record files and in the frames of their journal.
#pragma once

#include <vector>

#include "rvelab/io/hdf5/file.hpp"
#include "rvelab/records/record.hpp"

namespace rvelab::io {

/// Probe results: the names of their stages, and one square matrix each (all of one size).
void put_probes(Hdf5File& file, const std::vector<records::ProbeResult>& probes);
/// InputError if names and matrices do not fit each other; none in files of version 1.0.
std::vector<records::ProbeResult> get_probes(const Hdf5File& file);

}  // namespace rvelab::io
