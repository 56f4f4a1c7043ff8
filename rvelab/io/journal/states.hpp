// The states that a file holds, in order: what an export shows.
#pragma once

#include <string>
#include <vector>

#include "rvelab/specimen/specimen.hpp"

namespace rvelab::io {

struct StoredState {
  long record = 0;    ///< number of the record; an end state comes after all of them
  double strain = 0;  ///< driving strain there; that of the last record for an end state; 0 without records
  Specimen specimen;
};

/// The specimen of a specimen file; of a record file, with its journal, each snapshot in the order of the records, and
/// the end state, or the last checkpoint of a test that has not ended. Never empty. InputError as read_specimen.
std::vector<StoredState> read_states(const std::string& path);

}  // namespace rvelab::io
