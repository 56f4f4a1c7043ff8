// Changes that another program makes to an HDF5 file through HDF5 itself: values at the edge of their range, other
// shapes and types, datasets that are gone or exchanged, rows that stand twice or change places, other attributes.
#pragma once

#include "tests/fuzz/formats.hpp"

namespace rvelab::fuzz {

/// The file with up to four changes; none where there are no choices.
Bytes edited(View image, Choices& choices);

}  // namespace rvelab::fuzz
