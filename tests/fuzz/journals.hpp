// A journal with a frame of each type, whole and changed.
#pragma once

#include "tests/fuzz/formats.hpp"

namespace rvelab::fuzz {

Bytes whole_journal();

/// One of the parts that are HDF5 changed (hdf5_edits.hpp), with checksums that fit.
Bytes edited_journal(Choices& choices);

/// The same bytes with a checksum that fits each frame: of the records, and of the others as far as their HDF5 is that
/// of whole_journal().
Bytes with_checksums(View journal);

}  // namespace rvelab::fuzz
