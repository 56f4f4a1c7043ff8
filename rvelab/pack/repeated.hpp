// Larger specimens of smaller ones.
#pragma once

#include "rvelab/specimen/specimen.hpp"

namespace rvelab::pack {

/// A periodic specimen repeated along its cell vectors, contacts and interactions copied with what they keep.
/// InputError: a count
/// below 1.
Specimen repeated(const Specimen& specimen, const Image& times);

}  // namespace rvelab::pack
