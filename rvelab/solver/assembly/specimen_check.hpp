// What a specimen must be for an Rve to open it.
#pragma once

#include "rvelab/specimen/specimen.hpp"

namespace rvelab {

/// Throws InputError, which names the grain, contact or key, its value and the remedy.
void check_specimen(const Specimen& specimen);

/// Clears tangential forces of contacts whose materials give them no tangential stiffness.
void clear_forces_without_stiffness(Specimen& specimen);

}  // namespace rvelab
